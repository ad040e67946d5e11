//! Row 21: a current beyond a limit of the travel, and lowering with the dial shut.

use hitch_quantities::units::PerMille;

use super::*;

/// Limits well inside the ends.
const LOWEST: MilliDegree = MilliDegree(60_000);
const HIGHEST: MilliDegree = MilliDegree(120_000);
/// Beyond noise of the rig's sensor.
const CLEAR: i32 = 100;

static LIMITED: LazyLock<Calibration> = LazyLock::new(|| {
    let mut calibration = Calibration::nominal();
    calibration.position.lower_limit = LOWEST;
    calibration.position.upper_limit = HIGHEST;
    calibration
});

/// Steps until the row trips, of a hitch that creeps along with `order` from `angle`.
fn trips(order: Order, angle: i32, alter: impl Fn(&mut Inputs)) -> Option<i32> {
    let limits = Limits {
        machine: MachineModel::of(&LIMITED),
        ..limits()
    };
    let mut rig = Rig::armed_at(angle);
    let way = if let Order::Lower(_) = order { -1 } else { 1 };
    let tripped = (1..400).find(|step| {
        // 10 degrees a second, and no further than a tenth of a degree.
        rig.speed = if step % 20 < 10 { 10 * way } else { -10 * way };
        rig.step_within(limits, order, &alter);
        rig.envelope.tripped().is_some()
    });
    assert!(tripped.is_none() || rig.envelope.tripped() == Some(Trip::BeyondLimit));
    tripped
}

/// Currents at the thresholds, which require no travel.
const SLOW_LIFT: Order = Order::Lift(1_200);
const SLOW_LOWER: Order = Order::Lower(1_100);

/// The current of the first step is judged in the second.
const TIME: Option<i32> = Some(SAFETY.limit_time.0 + 1);

// REQ-SAFE-13
#[test]
fn a_current_that_drives_the_hitch_beyond_a_limit_trips() {
    let above = HIGHEST.0 + SAFETY.limit_margin.0;
    let below = LOWEST.0 - SAFETY.limit_margin.0;
    for (order, angle, time) in [
        (SLOW_LIFT, above + 2 * CLEAR, TIME),
        (SLOW_LIFT, above - 2 * CLEAR, None),
        (SLOW_LIFT, below - 2 * CLEAR, None),
        (SLOW_LOWER, below - 2 * CLEAR, TIME),
        (SLOW_LOWER, below + 2 * CLEAR, None),
        (SLOW_LOWER, above + 2 * CLEAR, None),
        (Order::Rest, above + 2 * CLEAR, None),
        (Order::Rest, below - 2 * CLEAR, None),
    ] {
        assert_eq!(trips(order, angle, |_| {}), time, "{order:?} at {angle}");
    }
}

// REQ-SAFE-13
#[test]
fn the_margin_itself_is_allowed() {
    let limits = Limits {
        machine: MachineModel::of(&LIMITED),
        ..limits()
    };
    for (order, limit, way) in [(SLOW_LIFT, HIGHEST, 1), (SLOW_LOWER, LOWEST, -1)] {
        for (further, time) in [(0, None), (1, TIME)] {
            let angle = limit.0 + way * (SAFETY.limit_margin.0 + further);
            let mut rig = Rig::armed_at(angle);
            let tripped = (1..150).find(|_| {
                rig.step_within(limits, order, |inputs| {
                    inputs.rocker_angle = Some(MilliDegree(angle));
                });
                rig.envelope.tripped().is_some()
            });
            assert_eq!(tripped, time, "{order:?} {further} mdeg beyond");
        }
    }
}

// REQ-SAFE-13
#[test]
fn the_dial_lowers_the_upper_limit_but_does_not_raise_it() {
    let dial =
        |angle: i32| move |inputs: &mut Inputs| inputs.upper_limit = Some(MilliDegree(angle));
    let beyond = |limit: i32| limit + SAFETY.limit_margin.0 + 2 * CLEAR;
    assert_eq!(trips(SLOW_LIFT, beyond(90_000), dial(90_000)), TIME);
    assert_eq!(trips(SLOW_LIFT, beyond(90_000), dial(93_000)), None);
    assert_eq!(trips(SLOW_LIFT, beyond(HIGHEST.0), dial(i32::MAX)), TIME);
    assert_eq!(trips(SLOW_LIFT, beyond(LOWEST.0), dial(i32::MIN)), TIME);
    assert_eq!(trips(SLOW_LIFT, LOWEST.0, dial(i32::MIN)), None);
    assert_eq!(trips(SLOW_LOWER, beyond(90_000), dial(90_000)), None);
}

// REQ-SAFE-13
#[test]
fn lowering_with_the_dial_shut_trips() {
    let shut = OperatorParameters::NOMINAL.dial_shut;
    let dial = |dial: PerMille| move |inputs: &mut Inputs| inputs.lowering_dial = Some(dial);
    let open = shut + PerMille(1);
    assert_eq!(trips(SLOW_LOWER, 90_000, dial(shut - PerMille(1))), TIME);
    assert_eq!(trips(SLOW_LOWER, 90_000, dial(shut)), None);
    assert_eq!(trips(SLOW_LOWER, 90_000, dial(open)), None);
    assert_eq!(trips(SLOW_LIFT, 90_000, dial(PerMille(0))), None);
    assert_eq!(trips(Order::Rest, 90_000, dial(PerMille(0))), None);
}

#[test]
fn teaching_moves_to_the_ends_beyond_the_limits() {
    let teaching = |inputs: &mut Inputs| {
        inputs.switches.teach = true;
        inputs.jog = Some(MilliDegreePerSecond(5_000));
        inputs.lowering_dial = Some(PerMille(0));
    };
    let beyond = SAFETY.limit_margin.0 + 2 * CLEAR;
    assert_eq!(trips(SLOW_LIFT, HIGHEST.0 + beyond, teaching), None);
    assert_eq!(trips(SLOW_LOWER, LOWEST.0 - beyond, teaching), None);
}

// REQ-SAFE-13
#[test]
fn an_angle_that_is_missing_is_beyond_no_limit() {
    let missing = |inputs: &mut Inputs| inputs.rocker_angle = None;
    let mut rig = Rig::moving(LIFT);
    rig.cut_after(LIFT, |inputs, _| missing(inputs));
    assert_eq!(rig.envelope.tripped(), Some(Trip::AngleMissing));
}
