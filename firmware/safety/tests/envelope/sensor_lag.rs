//! Rows 8, 10 and 11 behind an angle sensor that lags (`sensors.angle_lag`).

use hitch_quantities::piston::piston_speed;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, MilliBar, Millisecond, PerMille};

use super::*;

/// From a little more than the averages of the envelope to the longest of the nominal onset speed, ms.
const LAGS_MS: [i32; 3] = [50, 189, 480];
/// Mean of the rig's angle at 90 degrees: its noise is not symmetric.
const MEAN: i32 = 90_005;

/// A sensor of pressure shows that the load hangs.
fn hangs(inputs: &mut Inputs) {
    inputs.cylinder_pressure = Some(MilliBar(15_000));
}

/// The same, and the angle is held without noise.
fn still(inputs: &mut Inputs) {
    hangs(inputs);
    inputs.rocker_angle = Some(MilliDegree(90_000));
}

fn lagging(lag_ms: i32) -> SensorParameters {
    SensorParameters {
        angle_lag: Millisecond(lag_ms),
        ..SENSORS
    }
}

fn within<'a>(safety: &'a SafetyParameters, sensors: &'a SensorParameters) -> Limits<'a> {
    Limits {
        safety,
        sensors,
        ..limits()
    }
}

/// Piston speed by the valve curve, um/s.
fn speed(order: Order) -> i32 {
    let currents = order.currents();
    let flow = if currents.lift > MilliAmp::ZERO {
        NOMINAL.lift.flow(currents.lift)
    } else {
        NOMINAL.lower.flow(currents.lower)
    };
    piston_speed(flow, NOMINAL.hydraulics.piston_area).0
}

/// Rocker angle for a piston travel of a millimetre at an angle, thousandths of a degree.
fn degrees(angle: i32) -> i32 {
    let travel = |angle| NOMINAL.linkage.travel(MilliDegree(angle)).0;
    2_000_000 / (travel(angle + 1_000) - travel(angle - 1_000))
}

/// Of the way of so many steps at a steady speed, what a sensor with this lag has yet to show, steps.
fn hidden_steps(lag_ms: i32, steps: i32) -> f64 {
    let lag = f64::from(lag_ms.max(1));
    (lag - 1.0) * (1.0 - (1.0 - 1.0 / lag).powi(steps))
}

/// The first step in which the sensor has to have shown more than the way of so many.
fn shown_after(lag_ms: i32, most_steps: f64) -> i32 {
    (0..)
        .find(|&step| f64::from(step) - hidden_steps(lag_ms, step) > most_steps)
        .unwrap()
}

/// For how many steps a coil stays on.
fn on_for(
    rig: &mut Rig,
    limits: Limits<'_>,
    order: Order,
    fault: impl Fn(&mut Inputs),
) -> Option<i32> {
    (0..3_000).find(|_| rig.step_within(limits, order, &fault) == CoilCurrents::OFF)
}

/// What a sensor shows of a hitch that does not move.
type Fault = fn(&mut Inputs);

// REQ-SAFE-04
#[test]
fn rows_8_and_10_before_motion_require_travel_as_late_as_the_sensor_shows_it() {
    const STEPS: i32 = 50;
    let kinds: [(Fault, Trip); 2] = [(still, Trip::AngleFrozen), (hangs, Trip::NotFollowing)];
    for (order, (fault, trip)) in [Order::Lift(1_500), Order::Lower(1_400)]
        .into_iter()
        .flat_map(|order| kinds.map(|kind| (order, kind)))
    {
        let udeg = speed(order) * degrees(MEAN) / 1_000;
        let safety = SafetyParameters {
            onset_budget: MilliDegree(100_000),
            onset_debt: MilliDegree(STEPS * udeg / 1_000),
            ..SAFETY
        };
        for lag_ms in LAGS_MS {
            let sensors = lagging(lag_ms);
            let mut rig = Rig::armed();
            for _ in 0..200 {
                rig.step_within(within(&safety, &sensors), Order::Rest, fault);
            }
            let on = on_for(&mut rig, within(&safety, &sensors), order, fault).unwrap();
            let expected = shown_after(lag_ms, f64::from(STEPS));
            assert_eq!(rig.envelope.tripped(), Some(trip), "{order:?}, {lag_ms} ms");
            assert!(
                (on - expected).abs() <= 1,
                "{order:?}, {trip:?}, {lag_ms} ms: on for {on} steps, not {expected}"
            );
        }
    }
}

/// The ground holds it, or the pump at its relief pressure.
fn held(inputs: &mut Inputs) {
    inputs.cylinder_pressure = Some(MilliBar(0));
    inputs.pump_pressure = Some(NOMINAL.hydraulics.relief_pressure);
}

/// What the valves gave before is neither required nor yet to be shown.
#[test]
fn a_hitch_that_was_held_before_motion_is_judged_as_if_its_coil_came_on_then() {
    const STEPS: i32 = 50;
    const LAG_MS: i32 = 189;
    for order in [Order::Lift(1_500), Order::Lower(1_400)] {
        let udeg = speed(order) * degrees(MEAN) / 1_000;
        let safety = SafetyParameters {
            onset_budget: MilliDegree(100_000),
            onset_debt: MilliDegree(STEPS * udeg / 1_000),
            ..SAFETY
        };
        let sensors = lagging(LAG_MS);
        let limits = within(&safety, &sensors);
        let mut rig = Rig::armed();
        (0..100).for_each(|_| _ = rig.step_within(limits, order, hangs));
        rig.step_within(limits, order, held);
        let on = on_for(&mut rig, limits, order, hangs).unwrap();
        assert_eq!(rig.envelope.tripped(), Some(Trip::NotFollowing));
        // Its coil is on at once, a step earlier than one that has yet to come on.
        let expected = shown_after(LAG_MS, f64::from(STEPS)) - 1;
        assert!(
            (on - expected).abs() <= 1,
            "{order:?}: on for {on} steps, not {expected}"
        );
    }
}

/// A hitch that has crept, stands, and then gets a current of which all that the valve curve gives is required.
fn started(limits: Limits<'_>, order: Order) -> Rig {
    let (slow, way) = match order {
        Order::Lower(_) => (Order::Lower(1_199), -1),
        _ => (Order::Lift(1_326), 1),
    };
    let mut rig = Rig::armed();
    rig.speed = way * 2;
    (0..300).for_each(|_| _ = rig.step_within(limits, slow, hangs));
    rig.speed = 0;
    (0..200).for_each(|_| _ = rig.step_within(limits, slow, hangs));
    assert_eq!(rig.passed, slow.currents());
    rig
}

// REQ-SAFE-04
#[test]
fn row_10_after_a_start_requires_travel_as_late_as_the_sensor_shows_it() {
    const STEPS: i32 = 50;
    /// Required since it crept: half of 4 um a step, averaged over 24 steps.
    const CREPT_UM: i32 = 48;
    let margin = SAFETY.following_margin.0;
    for (order, less) in [
        (Order::Lift(1_800), Order::Lift(1_800 - margin)),
        (Order::Lower(1_700), Order::Lower(1_700 - margin)),
    ] {
        let safety = SafetyParameters {
            started_lag: Millisecond(1),
            following_share: PerMille(1_000),
            following_speed: MicrometrePerSecond(0),
            following_allowance: Micrometre(STEPS * speed(less) / 1_000),
            ..SAFETY
        };
        for lag_ms in LAGS_MS {
            let sensors = lagging(lag_ms);
            let limits = within(&safety, &sensors);
            let mut rig = started(limits, order);
            let on = on_for(&mut rig, limits, order, hangs).unwrap();
            let latest = shown_after(lag_ms, f64::from(STEPS));
            let crept = f64::from(CREPT_UM) * 1e3 / f64::from(speed(less));
            let earliest = shown_after(lag_ms, f64::from(STEPS) - crept);
            assert_eq!(rig.envelope.tripped(), Some(Trip::NotFollowing));
            assert!(
                (earliest - 1..=latest + 1).contains(&on),
                "{order:?}, {lag_ms} ms: on for {on} steps, not {earliest} to {latest}"
            );
        }
    }
}

// REQ-SAFE-04
/// The sensor has shown this speed: a lag does not explain that it is gone.
#[test]
fn a_sensor_with_lag_that_stops_in_motion_is_found_as_soon_as_one_without() {
    for order in [LIFT, LOWER] {
        let on = |lag_ms| {
            let sensors = lagging(lag_ms);
            let limits = within(&SAFETY, &sensors);
            let mut rig = Rig::moving(order);
            (0..60).for_each(|_| _ = rig.step_within(limits, order, hangs));
            rig.speed = 0;
            let on = on_for(&mut rig, limits, order, hangs).unwrap();
            assert_eq!(rig.envelope.tripped(), Some(Trip::NotFollowing));
            on
        };
        for lag_ms in LAGS_MS {
            assert!(on(lag_ms) <= on(0) + 1, "{order:?}, {lag_ms} ms");
        }
    }
}

/// How far an angle may go against a coil that comes on after a steady motion and `pause` steps, thousandths of a degree.
fn bears_against(lag_ms: i32, before: Order, steps: i32, pause: i32, coil: Order) -> i32 {
    let sensors = lagging(lag_ms);
    let limits = within(&SAFETY, &sensors);
    let udeg = speed(before) * degrees(MEAN) / 1_000;
    let way = |order| match order {
        Order::Lower(_) => -1,
        _ => 1,
    };
    let moved = way(before) * udeg / 1_000;
    let mut rig = Rig::armed_at(90_000 - steps * moved);
    (0..100).for_each(|_| _ = rig.step_within(limits, Order::Rest, hangs));
    rig.speed = moved;
    (0..steps).for_each(|_| _ = rig.step_within(limits, before, hangs));
    assert_eq!(rig.passed, before.currents());
    rig.speed = 0;
    (0..pause).for_each(|_| _ = rig.step_within(limits, Order::Rest, hangs));
    let first = rig.angle;
    rig.step_within(limits, coil, hangs);
    rig.speed = -20 * way(coil);
    on_for(&mut rig, limits, coil, hangs).unwrap();
    assert_eq!(rig.envelope.tripped(), Some(Trip::Against));
    (rig.angle - first).abs()
}

/// Currents of row 11: that of the motion, and one of which nothing is required, each both ways.
const UP: [Order; 2] = [Order::Lift(1_500), Order::Lift(1_326)];
const DOWN: [Order; 2] = [Order::Lower(1_400), Order::Lower(1_199)];
/// Noise of the rig to and fro, and a step, thousandths of a degree.
const TOLERANCE: i32 = 100;

// REQ-SAFE-05
#[test]
fn row_11_allows_twice_the_travel_that_is_yet_to_be_shown_of_a_motion_the_other_way() {
    const STEPS: i32 = 300;
    for (before, coil) in [(DOWN[0], UP[1]), (UP[0], DOWN[1])] {
        for lag_ms in LAGS_MS {
            let hidden_um = hidden_steps(lag_ms, STEPS) * f64::from(speed(before)) * 1e-3;
            let hidden = (hidden_um * f64::from(degrees(MEAN)) * 1e-3) as i32;
            let most = SAFETY.contradiction.0 + 2 * hidden;
            let back = bears_against(lag_ms, before, STEPS, 0, coil);
            assert!(
                (back - most).abs() <= TOLERANCE + most / 50,
                "{coil:?}, {lag_ms} ms: {back}, not {most} mdeg"
            );
        }
    }
}

// REQ-SAFE-05
#[test]
fn row_11_allows_no_more_than_its_limit_after_a_motion_the_same_way_or_one_that_has_been_shown() {
    let most = SAFETY.contradiction.0;
    for ([up, up_slow], [down, _]) in [(UP, DOWN), (DOWN, UP)] {
        for lag_ms in LAGS_MS {
            let same = bears_against(lag_ms, up, 300, 10, up_slow);
            let shown = bears_against(lag_ms, down, 300, 8 * lag_ms, up_slow);
            for back in [same, shown] {
                assert!(
                    (back - most).abs() <= TOLERANCE,
                    "{up_slow:?}, {lag_ms} ms: {back} mdeg"
                );
            }
        }
    }
}
