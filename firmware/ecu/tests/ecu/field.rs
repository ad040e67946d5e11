//! Speeds, draft and their troubles, from frames to the controller and back.

use hitch_ecu::{AdcCode, Contact, Contacts, Panel};
use hitch_protocols::j1939::{Id, Pgn};
use hitch_quantities::units::{Count, MillimetrePerSecond, PerMille};
use hitch_quantities::{Inputs, Reason, State, Trouble};

use crate::bench::{Bench, Flash, code};
use crate::engine::{of_the_board, stored};

/// A calibration with draft pins and slip guard.
fn fitted() -> Flash {
    let mut block = of_the_board();
    block.draft.fitted = Count(1);
    block.slip.highest_limit = PerMille(300);
    stored(block)
}

/// The data of the last message of a group.
fn last(bench: &Bench, pgn: Pgn) -> [u8; 8] {
    let data = bench.sent.iter().rev().find_map(|(_, frame)| {
        let id = frame.extended_data_id().map(Id::unpack)?;
        (id.pgn == pgn).then(|| frame.eight().copied())
    });
    data.flatten().unwrap()
}

#[test]
fn a_speed_reaches_the_controller_in_the_next_millisecond_and_only_then() {
    let mut bench = Bench::start(Flash::blank());
    let speeds = |inputs: &Inputs| (inputs.ground_speed, inputs.wheel_speed);
    for (pgn, raw, expected) in [
        (
            Pgn::GROUND_SPEED,
            1_800_u16,
            (Some(MillimetrePerSecond(1_800)), None),
        ),
        (
            Pgn::WHEEL_SPEED,
            2_000,
            (None, Some(MillimetrePerSecond(2_000))),
        ),
    ] {
        let [low, high] = raw.to_le_bytes();
        bench.receive(pgn, 240, [low, high, 0, 0, 0, 0, 0xFF, 0xFD]);
        // Frames are received at the end of a millisecond.
        bench.run(1);
        assert_eq!(speeds(bench.machine.ecu().inputs()), (None, None));
        bench.run(1);
        assert_eq!(speeds(bench.machine.ecu().inputs()), expected);
        bench.run(1);
        assert_eq!(speeds(bench.machine.ecu().inputs()), (None, None));
    }
}

#[test]
fn without_draft_pins_there_is_no_draft_and_no_trouble() {
    let mut bench = Bench::start(stored(of_the_board()));
    bench.run(3_000);
    assert_eq!(last(&bench, Pgn::REAR_HITCH_STATUS)[3..5], [0xFF, 0xFF]);
    assert_eq!(last(&bench, Pgn::DM1)[2..5], [0, 0, 0]);
}

#[test]
fn pins_that_are_fitted_and_not_there_are_a_trouble_in_any_state() {
    let mut bench = Bench::start(fitted());
    bench.run(3_000);
    // 0xFE00: error. SPN 1879 = 0x757, FMI 31.
    assert_eq!(last(&bench, Pgn::REAR_HITCH_STATUS)[3..5], [0x00, 0xFE]);
    assert_eq!(last(&bench, Pgn::DM1)[2..5], [0x57, 0x07, 31]);
    bench.pick_up(110_000);
    bench.run(2_000);
    assert!(bench.angle() > 100_000, "position control goes on");
    assert_eq!(last(&bench, Pgn::DM1)[2..5], [0x57, 0x07, 31]);
}

/// Angle at which the implement touches the ground, thousandths of a degree.
const GROUND: i32 = 90_000;
/// Draft of the soil, N per degree below the ground.
const SOIL_N: f64 = 900.0;
/// Nominal force of both pins of the untaught calibration, N.
const SPAN_N: f64 = 80_000.0;

/// A field: the draft is proportional to the depth, and shared by both pins.
#[derive(Default)]
struct Field {
    /// Position of the dial of the set point, 0 to 1.
    dial: f64,
    /// The wire of the left pin is broken.
    broken: bool,
}

impl Field {
    fn connect(&self, angle: i32, now_ms: u32, contacts: &mut Contacts) {
        let draft_n = SOIL_N * f64::from((GROUND - angle).max(0)) * 1e-3;
        let pin = code(0.5 + 0.25 * draft_n / SPAN_N);
        let tremble = |by: u32| AdcCode::new(pin.get() + ((now_ms + by) % 3) as u16);
        let samples = &mut contacts.samples;
        samples.left_pin = if self.broken {
            AdcCode::default()
        } else {
            tremble(0)
        };
        samples.right_pin = tremble(1);
        samples.set_point_dial = code(0.1 + 0.8 * self.dial);
    }

    fn run(&self, bench: &mut Bench, ms: u32) {
        for _ in 0..ms {
            let (angle, now_ms) = (bench.angle(), bench.now_ms);
            bench.step_with(|contacts| self.connect(angle, now_ms, contacts));
        }
    }
}

/// A hitch in the soil, by the lever, with draft pins.
fn in_the_soil(field: &Field) -> Bench {
    let mut block = of_the_board();
    block.draft.fitted = Count(1);
    let mut bench = Bench::start(stored(block));
    field.run(&mut bench, 300);
    for lever in [80_000, 95_000, 80_000] {
        bench.lever = lever;
        field.run(&mut bench, if lever == 80_000 { 50 } else { 100 });
    }
    field.run(&mut bench, 3_000);
    assert!((bench.angle() - 80_000).abs() < 1_000, "{}", bench.angle());
    bench
}

#[test]
fn the_selected_draft_moves_the_hitch_to_the_force_of_the_dial() {
    let mut field = Field::default();
    let mut bench = in_the_soil(&field);
    for wanted_n in [4_500.0, 11_000.0] {
        field.dial = wanted_n / SPAN_N;
        bench.panel = Panel::FIELD.with(Contact::Draft, true);
        field.run(&mut bench, 20_000);
        let found_n = SOIL_N * f64::from(GROUND - bench.angle()) * 1e-3;
        println!("{wanted_n} N wanted, {found_n} N");
        // One step of the set point, `draft.step`, is 4.5 degrees.
        assert!(
            (found_n - wanted_n).abs() < 0.5 * 4.5 * SOIL_N,
            "{found_n} N"
        );
        let outputs = bench.machine.ecu().outputs();
        assert_eq!(outputs.reference, Some(Reason::Draft), "{outputs:?}");
    }
}

#[test]
fn a_broken_wire_of_a_pin_or_of_the_dial_leaves_the_hitch_where_it_is() {
    for pin in [true, false] {
        let mut field = Field {
            dial: 9_000.0 / SPAN_N,
            broken: false,
        };
        let mut bench = in_the_soil(&field);
        bench.panel = Panel::FIELD.with(Contact::Draft, true);
        field.run(&mut bench, 3_000);
        let before = bench.angle();
        if pin {
            field.broken = true;
        } else {
            // 0.3 V of 5 V are below the dial's range, and below 0.25 V its wire is broken.
            field.dial = -0.1;
        }
        field.run(&mut bench, 1_000);
        let outputs = bench.machine.ecu().outputs();
        let moved = bench.angle() - before;
        println!("pin {pin}: moved by {moved} thousandths of a degree");
        assert_eq!(outputs.trouble, pin.then_some(Trouble::PinRange));
        assert!(moved.abs() < 3_000, "{moved}");
        assert_ne!(outputs.reference, Some(Reason::Draft));
    }
}

#[test]
fn the_engagement_switch_lowers_a_raised_hitch_into_the_soil() {
    let field = Field {
        dial: 9_000.0 / SPAN_N,
        broken: false,
    };
    let mut bench = in_the_soil(&field);
    bench.panel = Panel::FIELD
        .with(Contact::Draft, true)
        .with(Contact::QuickLift, true);
    field.run(&mut bench, 3_000);
    assert!(bench.angle() > 120_000, "{}", bench.angle());
    bench.panel = Panel::FIELD.with(Contact::Draft, true);
    field.run(&mut bench, 500);
    bench.panel = bench.panel.with(Contact::Engage, true);
    field.run(&mut bench, 3_000);
    println!("{} thousandths of a degree", bench.angle());
    assert!(bench.angle() < GROUND, "{}", bench.angle());
    assert_ne!(bench.state(), State::Fault);
}
