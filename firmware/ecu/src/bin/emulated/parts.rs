//! What the parts of a step take: the valve maps, the proportional and integral part of a coil's current, all of
//! the currents' regulation, and the reference layer of draft, depth and slip control.
//!
//! A part is called by address, and so is a function that does nothing; the difference is the part's own.

use core::hint::black_box;

use hitch_control::current::Regulation;
use hitch_control::current::pi::{Gains, ProportionalIntegral, VoltageRange};
use hitch_control::operator::engage::Engagement;
use hitch_control::reference::{ReferenceControl, Situation};
use hitch_control::valve::valve_map::{ValveCurves, ValveMap};
use hitch_quantities::units::{
    Count, MicroLitrePerSecond, Micrometre, MicrometrePerSecond, MilliAmp, MilliBar, MilliDegree,
    MilliVolt, MillimetrePerSecond, Newton, PerMille, SupplyShare,
};
use hitch_quantities::{Calibration, CoilCurrents, Inputs, ValidCalibration};

use crate::console::print;
use crate::outcome::Failure;
use crate::stopwatch::Stopwatch;
use crate::word::Word;

/// From no flow to beyond saturation, ul/s.
const FLOWS: core::ops::RangeInclusive<i32> = 0..=1_000_000;
const FLOW_STEP: usize = 997;

/// Says the most ticks that each part took. Not merged into its caller, whose stack it would take for good.
#[inline(never)]
pub fn run(stopwatch: &Stopwatch) -> Result<(), Failure> {
    let calibration = Calibration::nominal().validate()?;
    time_maps(stopwatch, &calibration);
    time_pi(stopwatch, &calibration);
    time_regulation(stopwatch, &calibration);
    time_reference(stopwatch);
    Ok(())
}

/// A part: what it works on, and what is asked of it.
type Part<T> = fn(&T, MicroLitrePerSecond, MilliBar) -> MilliAmp;

/// The most ticks of a part over all flows, and drops from 1 to 200 bar.
#[inline(never)]
fn most_ticks<T>(stopwatch: &Stopwatch, part: Part<T>, on: &T) -> u32 {
    let nothing: Part<T> = |_, _, _| MilliAmp::ZERO;
    let mut most = 0;
    for flow in FLOWS.step_by(FLOW_STEP) {
        let drop = MilliBar(1_000 + flow / 5);
        let ticks = [part, nothing].map(|part| {
            ticks_of_call(
                stopwatch,
                black_box(part),
                on,
                MicroLitrePerSecond(flow),
                drop,
            )
        });
        most = ticks[0].saturating_sub(ticks[1]).max(most);
    }
    most
}

/// The ticks of one call. There is one copy of this code, so that all parts, and the one that does nothing, are called
/// alike.
#[inline(never)]
fn ticks_of_call<T>(
    stopwatch: &Stopwatch,
    part: Part<T>,
    on: &T,
    flow: MicroLitrePerSecond,
    drop: MilliBar,
) -> u32 {
    stopwatch.ticks_of(|| part(on, flow, drop)).1
}

#[inline(never)]
fn time_maps(stopwatch: &Stopwatch, calibration: &ValidCalibration) {
    let curves = ValveCurves::of(calibration);
    let map = curves.at(curves.scale(MilliBar(7_000)));
    let lift: Part<ValveMap<'_>> = |map, flow, _| map.lift_current(flow);
    let lower: Part<ValveMap<'_>> = |map, flow, _| map.lower_current(flow);
    let both: Part<ValveCurves> =
        |curves, flow, drop| curves.at(curves.scale(drop)).lower_current(flow);
    report("lift_map=", most_ticks(stopwatch, lift, &map));
    report("lower_map=", most_ticks(stopwatch, lower, &map));
    report(
        "lower_map_of_flow_and_drop=",
        most_ticks(stopwatch, both, &curves),
    );
}

/// What proportional and integral part work on, as far as it doesn't change from step to step.
struct PiLoop {
    pi: ProportionalIntegral,
    gains: Gains,
    given: VoltageRange,
}

/// A step of theirs, for the current that is wanted, the one that is measured and the voltage that is needed at rest.
type PiStep = fn(&mut PiLoop, MilliAmp, MilliAmp, i32) -> i32;

/// The most ticks of proportional and integral part, over errors, rests and supplies that reach every branch: what is
/// asked for is beyond the supply, or below nothing, and the integral grows there, or stops, or is cut short.
#[inline(never)]
fn time_pi(stopwatch: &Stopwatch, calibration: &ValidCalibration) {
    let step: PiStep =
        |on, wanted, measured, rest_uv| on.pi.step(on.gains, wanted - measured, rest_uv, &on.given);
    let nothing: PiStep = |_, _, _, _| 0;
    let mut on = PiLoop {
        pi: ProportionalIntegral::NEW,
        gains: Gains::of(&calibration.current),
        given: VoltageRange {
            least_uv: -700_000,
            most_uv: 0,
        },
    };
    let mut most = 0;
    for at in 0..6_000 {
        // Without a common divisor these meet in every way.
        let wanted = MilliAmp(at % 89 * 200 - 7_900);
        let rest_uv = at % 31 * 1_000_000;
        on.given.most_uv = 4_000_000 + at % 7 * 2_500_000;
        let ticks = [step, nothing].map(|part| {
            let part = black_box(part);
            ticks_of_pi(stopwatch, part, &mut on, wanted, rest_uv)
        });
        most = ticks[0].saturating_sub(ticks[1]).max(most);
    }
    report("pi=", most);
}

/// The ticks of one such step: see [`ticks_of_call`].
#[inline(never)]
fn ticks_of_pi(
    stopwatch: &Stopwatch,
    step: PiStep,
    on: &mut PiLoop,
    wanted: MilliAmp,
    rest_uv: i32,
) -> u32 {
    let measured = MilliAmp(1_000);
    stopwatch.ticks_of(|| step(on, wanted, measured, rest_uv)).1
}

#[inline(never)]
fn time_regulation(stopwatch: &Stopwatch, calibration: &ValidCalibration) {
    type Step = fn(&mut Regulation, CoilCurrents, &Inputs, &Calibration) -> i32;
    let drive: Step = |regulation, asked, inputs, calibration| {
        let duties = regulation.drive(asked, inputs, &calibration.current);
        duties.lift.0 ^ duties.lower.0
    };
    let nothing: Step = |_, _, _, _| 0;
    let mut regulation = Regulation::new(&calibration.current);
    let mut most = [0; 2];
    for step in 0..4_000 {
        let current = MilliAmp(step / 100 % 20 * 150);
        let both = step >= 2_000;
        let asked = CoilCurrents {
            lift: current,
            lower: if both { current } else { MilliAmp::ZERO },
        };
        let measured = Some(current - MilliAmp(step % 100));
        let inputs = Inputs {
            supply: Some(MilliVolt(13_800)),
            lift_current: measured,
            lower_current: measured,
            ..Inputs::default()
        };
        let ticks = [drive, nothing].map(|part| {
            let part = black_box(part);
            stopwatch
                .ticks_of(|| part(&mut regulation, asked, &inputs, calibration))
                .1
        });
        let most = &mut most[usize::from(both)];
        *most = ticks[0].saturating_sub(ticks[1]).max(*most);
    }
    report("regulation_of_one_coil=", most[0]);
    report("regulation_of_both_coils=", most[1]);
}

/// The most ticks of sensors and set point of the reference layer, over functions, drafts, depths and slips that reach the soil,
/// the limits and the guard. The layer of a machine without pins and depth sensor takes none.
#[inline(never)]
fn time_reference(stopwatch: &Stopwatch) {
    type Step = fn(&mut ReferenceControl, &Inputs, &Situation, &Calibration) -> i32;
    let layer: Step = |layer, inputs, situation, calibration| {
        layer.sense(inputs, false, calibration);
        layer.step(inputs, situation, calibration).0
    };
    let nothing: Step = |_, _, _, _| 0;
    let mut calibration = Calibration::nominal();
    calibration.draft.fitted = Count(1);
    calibration.depth.fitted = Count(1);
    calibration.slip.highest_limit = PerMille(300);
    let mut on = ReferenceControl::default();
    let mut most = 0;
    for step in 0..20_000 {
        // Without a common divisor these meet in every way.
        let function = step / 500 % 5;
        let draft = step / 1_300 % 5 * 600;
        let is_received = step % 100 == 0;
        let speed = |speed| is_received.then_some(MillimetrePerSecond(speed + step / 100 % 3));
        let inputs = Inputs {
            left_pin: Some(SupplyShare(50_000 + 5 * draft + step % 7)),
            right_pin: Some(SupplyShare(50_000 + 5 * draft + step % 5)),
            ground_speed: speed(1_500),
            wheel_speed: speed(1_500 + step / 1_700 % 4 * 250),
            draft_set_point: Some(Newton(18_000)),
            depth_sensor: Some(SupplyShare(25_000 + 10 * draft + step % 7)),
            depth_set_point: Some(Micrometre(250_000)),
            function: Some(Count(function)),
            ..Inputs::default()
        };
        let situation = Situation {
            lever: MilliDegree(62_000),
            angle: MilliDegree(62_000 + step % 11 * 1_000),
            highest: MilliDegree(75_000),
            valve_speeds: [MicrometrePerSecond(150_000); 2],
            engagement: engagement(step),
        };
        let ticks = [layer, nothing].map(|part| {
            let part = black_box(part);
            stopwatch
                .ticks_of(|| part(&mut on, &inputs, &situation, &calibration))
                .1
        });
        most = ticks[0].saturating_sub(ticks[1]).max(most);
    }
    report("reference_layer=", most);
}

/// Quick engagement in every seventh stretch of 700 steps.
fn engagement(step: i32) -> Engagement {
    match step % 4_900 {
        0 => Engagement::Begins,
        1..700 => Engagement::Held,
        _ => Engagement::Off,
    }
}

fn report(name: &str, ticks: u32) {
    print(&[Word::Text(name), Word::Number(ticks), Word::Text("\n")]);
}
