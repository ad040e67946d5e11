//! How much travel a hitch may owe, to the step.

use hitch_quantities::piston::piston_speed;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, MilliBar, Millisecond, PerMille};

use super::*;

/// Mean of the rig's angle at 90 degrees: its noise is not symmetric.
const MEAN: i32 = 90_005;
/// Samples that the mean is of.
const MEAN_STEPS: i32 = 16;

/// A sensor of pressure shows that the load hangs.
fn hangs(inputs: &mut Inputs) {
    inputs.cylinder_pressure = Some(MilliBar(15_000));
}

fn within(safety: &SafetyParameters) -> Limits<'_> {
    Limits { safety, ..limits() }
}

/// Piston speed by the valve curve, um/s.
fn speed(order: Order) -> i32 {
    let flow = match order {
        Order::Rest => return 0,
        Order::Lift(current) => NOMINAL.lift.flow(MilliAmp(current)),
        Order::Lower(current) => NOMINAL.lower.flow(MilliAmp(current)),
    };
    piston_speed(flow, NOMINAL.hydraulics.piston_area).0
}

/// Travel of a step before motion is seen, at a mean angle, millionths of a degree.
fn step_udeg(order: Order, mean: i32) -> i32 {
    let travel = |angle| NOMINAL.linkage.travel(MilliDegree(angle)).0;
    let um = travel(mean + 1_000) - travel(mean - 1_000);
    speed(order) * (2_000_000 / um) / 1_000
}

/// For how many steps a coil stays on, of a hitch whose angle stands still from now on.
fn standing(rig: &mut Rig, safety: &SafetyParameters, order: Order) -> i32 {
    rig.speed = 0;
    let cut = (0..2_000)
        .find(|_| rig.step_within(within(safety), order, hangs) == CoilCurrents::OFF)
        .expect("it owes travel");
    assert_eq!(rig.envelope.tripped(), Some(Trip::NotFollowing));
    cut
}

#[test]
fn the_onset_debt_may_be_owed_and_no_more() {
    const STEPS: i32 = 50;
    for order in [Order::Lift(1_500), Order::Lower(1_400)] {
        let safety = SafetyParameters {
            onset_budget: MilliDegree(100_000),
            onset_debt: MilliDegree(STEPS * step_udeg(order, MEAN) / 1_000),
            ..SAFETY
        };
        let steps = standing(&mut Rig::armed(), &safety, order);
        assert_eq!(steps, STEPS + 1, "{order:?}");
    }
}

#[test]
fn a_hitch_lifted_off_its_lower_end_stop_may_owe_the_stop_debt_as_well() {
    const STEPS: i32 = 50;
    let order = Order::Lift(1_500);
    for (angle, at_stop) in [(44_000, true), (48_500, true), (48_700, false)] {
        let udeg = step_udeg(order, angle + MEAN - 90_000);
        let debt = STEPS * udeg / 1_000;
        let steps = |stop_debt| {
            let safety = SafetyParameters {
                onset_budget: MilliDegree(100_000),
                onset_debt: MilliDegree(debt),
                stop_debt: MilliDegree(stop_debt),
                ..SAFETY
            };
            standing(&mut Rig::armed_at(angle), &safety, order)
        };
        let more = if at_stop { STEPS } else { 0 };
        let both = 2 * STEPS * udeg / 1_000;
        assert_eq!(steps(0), STEPS + 1, "{angle}");
        assert_eq!(steps(both - debt), STEPS + 1 + more, "{angle}");
    }
}

/// A hitch in motion that owes all that the valve curve gives, and gets going at once.
fn owing_all(allowance_um: i32) -> SafetyParameters {
    SafetyParameters {
        following_margin: MilliAmp(0),
        started_lag: Millisecond(1),
        following_share: PerMille(1_000),
        following_allowance: Micrometre(allowance_um),
        ..SAFETY
    }
}

/// At 90 degrees, 18 degrees into a stroke at full speed.
fn under_way(safety: &SafetyParameters, order: Order) -> Rig {
    let mut rig = Rig::armed();
    rig.speed = match order {
        Order::Lower(_) => -FULL_SPEED,
        _ => FULL_SPEED,
    };
    for _ in 0..300 {
        rig.step_within(within(safety), order, hangs);
    }
    assert_eq!(rig.passed, order.currents());
    rig
}

#[test]
fn the_allowance_may_be_owed_and_no_more() {
    const STEPS: i32 = 50;
    for order in [Order::Lift(1_500), Order::Lower(1_400)] {
        let owed_um = STEPS * speed(order) / 1_000;
        let steps = |allowance_um| {
            let safety = owing_all(allowance_um);
            standing(&mut under_way(&safety, order), &safety, order)
        };
        let at_limit = steps(owed_um);
        // Half a step's travel more makes no difference, a micrometre less makes a step.
        assert_eq!(at_limit, steps(owed_um + speed(order) / 2_000), "{order:?}");
        assert_eq!(at_limit, steps(owed_um - 1) + 1, "{order:?}");
    }
}

#[test]
fn a_hitch_faster_than_its_valve_owes_half_of_what_the_current_less_half_the_margin_gives() {
    let half = SAFETY.following_margin.0 / 2;
    for (order, less) in [
        (Order::Lift(1_500), Order::Lift(1_500 - half)),
        (Order::Lower(1_700), Order::Lower(1_700 - half)),
    ] {
        // Owed while the speed lately seen is still above that.
        let safety = SafetyParameters {
            following_allowance: Micrometre(250),
            ..SAFETY
        };
        let ms = standing(&mut under_way(&safety, order), &safety, order);
        let owed_ms = safety.following_allowance.0 * 1_000 / (speed(less) / 2);
        let seen_ms = ms - owed_ms;
        assert!(
            (0..=MEAN_STEPS).contains(&seen_ms),
            "{order:?}: {ms} ms, owed in {owed_ms} ms"
        );
    }
}

/// A load that swings, or is taken up from the ground, may stand for a time that hardly depends on the current.
#[test]
fn a_hitch_in_motion_owes_the_following_speed_but_no_more_than_half_of_what_the_current_gives() {
    const STEPS: i32 = 50;
    for (order, creeping, way) in [
        (Order::Lift(1_900), Order::Lift(1_100), 1),
        (Order::Lower(1_800), Order::Lower(990), -1),
    ] {
        let half = speed(order) / 2;
        for (following_speed, owed) in [(half / 2, half / 2), (half + 10_000, half)] {
            let steps = |allowance_um| {
                let safety = SafetyParameters {
                    following_speed: MicrometrePerSecond(following_speed),
                    following_share: PerMille(10),
                    ..owing_all(allowance_um)
                };
                let mut rig = Rig::armed();
                rig.speed = way * 2;
                for _ in 0..300 {
                    rig.step_within(within(&safety), creeping, hangs);
                }
                standing(&mut rig, &safety, order)
            };
            let owed_um = STEPS * owed / 1_000;
            let more = steps(2 * owed_um) - steps(owed_um);
            assert_eq!(more, STEPS, "{order:?}, {following_speed} um/s");
        }
    }
}
