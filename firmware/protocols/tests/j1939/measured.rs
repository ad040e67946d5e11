//! What loggers are told, against frames that were reckoned by hand from the scales in `hitch.dbc`.

use hitch_protocols::can::Frame;
use hitch_protocols::j1939::measured::TIME_WRAPS_MS;
use hitch_protocols::j1939::{Id, MeasuredBroadcast, Pgn};
use hitch_quantities::Inputs;
use hitch_quantities::signals::charge::CoilCharge;
use hitch_quantities::units::{MilliAmp, MilliBar, MilliDegree, MilliVolt, Millisecond};

const SOURCE: u8 = 0x80;
const PERIOD: Millisecond = Millisecond(20);

fn measured() -> Inputs {
    Inputs {
        lift_current: Some(MilliAmp(1_234)),
        lower_current: Some(MilliAmp(-5)),
        rocker_angle: Some(MilliDegree(90_126)),
        cylinder_pressure: Some(MilliBar(16_704)),
        pump_pressure: Some(MilliBar(-26)),
        supply: Some(MilliVolt(13_500)),
        ..Inputs::default()
    }
}

fn at(now_ms: u32, inputs: &Inputs) -> [Frame; 2] {
    let mut broadcast = MeasuredBroadcast::default();
    let mut charge = CoilCharge::default();
    let mut frames = None;
    for time_ms in now_ms - PERIOD.0.unsigned_abs()..=now_ms {
        charge = charge.after(inputs);
        frames = broadcast.poll(SOURCE, time_ms, PERIOD, inputs, charge);
    }
    frames.expect("one is due after a period")
}

#[test]
fn scales_are_those_of_the_description() {
    let [motion, pressures] = at(TIME_WRAPS_MS + 0x1234, &measured());
    // 33 234 mA and 31 995 mA above -32 A, 29 013 hundredths of a degree above -200, and the time, which went round.
    assert_eq!(
        motion.data(),
        [0xD2, 0x81, 0xFB, 0x7C, 0x55, 0x71, 0x34, 0x12]
    );
    // 6 670 and 4 997 hundredths of a bar above -50 (rounded), 13 500 mV.
    assert_eq!(
        pressures.data(),
        [0x0E, 0x1A, 0x85, 0x13, 0xBC, 0x34, 0x34, 0x12]
    );
    let groups = [motion, pressures].map(|frame| Id::unpack(frame.extended_data_id().unwrap()).pgn);
    assert_eq!(groups, [Pgn::HITCH_MOTION, Pgn::HITCH_PRESSURES]);
}

#[test]
fn what_is_not_measured_or_does_not_fit_is_no_other_value() {
    let [motion, pressures] = at(20, &Inputs::default());
    assert_eq!(motion.data(), [0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 20, 0]);
    assert_eq!(pressures.data(), motion.data());
    let absurd = Inputs {
        lift_current: Some(MilliAmp(40_000)),
        lower_current: Some(MilliAmp(-40_000)),
        ..Inputs::default()
    };
    let [motion, _] = at(20, &absurd);
    assert_eq!(motion.data()[..4], [0xFF, 0xFA, 0, 0], "the ends");
}

#[test]
fn a_current_is_its_mean_since_the_last_time() {
    let mut broadcast = MeasuredBroadcast::default();
    let mut charge = CoilCharge::default();
    let mut said = Vec::new();
    // With dither, and cut 5 ms before the third time.
    for time_ms in 0..=40 {
        let dither_ma = if time_ms % 8 < 4 { 100 } else { -100 };
        let inputs = Inputs {
            lift_current: Some(MilliAmp(if time_ms <= 35 { 1_500 + dither_ma } else { 0 })),
            ..Inputs::default()
        };
        charge = charge.after(&inputs);
        let frames = broadcast.poll(SOURCE, time_ms, PERIOD, &inputs, charge);
        said.extend(frames.map(|[motion, _]| {
            i32::from(u16::from_le_bytes([motion.data()[0], motion.data()[1]])) - 32_000
        }));
    }
    // Of steps 1 to 20 the dither is up in 11; of the 15 that are left of the next 20, in 8.
    assert_eq!(said, [1_600, 1_510, 1_130]);
}

#[test]
fn it_comes_as_often_as_the_calibration_says() {
    let times = |period: i32| {
        let mut broadcast = MeasuredBroadcast::default();
        // The counter goes round on the way.
        let (inputs, charge) = (Inputs::default(), CoilCharge::default());
        let mut due = |now_ms| broadcast.poll(SOURCE, now_ms, Millisecond(period), &inputs, charge);
        let ticks = (0..100_u32).map(|tick| tick.wrapping_sub(50));
        ticks.filter(|&now_ms| due(now_ms).is_some()).count()
    };
    assert_eq!((times(20), times(1), times(0), times(-7)), (5, 100, 0, 0));
}
