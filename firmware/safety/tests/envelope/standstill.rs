//! Rows 8 and 10: an angle that stands still although a coil must have moved the hitch.

use hitch_quantities::piston::piston_speed;
use hitch_quantities::units::{MicrometrePerSecond, MilliBar};

use super::*;

/// Longest from a freeze at 60 degrees a second until both coils are off, ms: 3.6 degrees.
const IN_MOTION_MS: i32 = 60;
/// The same of a sensor that was frozen before the coil came on, at a slow speed.
const AT_THE_START_MS: usize = 4_000;

/// A sensor of pressure shows that the load hangs.
fn hangs(inputs: &mut Inputs) {
    inputs.cylinder_pressure = Some(MilliBar(15_000));
}

/// Still from the start, at an angle and an order: what trips within so many steps, and whether both coils went off.
fn still(
    angle: i32,
    order: Order,
    steps: usize,
    tell: impl Fn(&mut Inputs),
) -> (Option<Trip>, bool) {
    let mut rig = Rig::armed_at(angle);
    let off = (0..steps)
        .map(|_| rig.step_with(order, &tell) == CoilCurrents::OFF)
        .last();
    (rig.envelope.tripped(), off == Some(true))
}

// REQ-SAFE-04
#[test]
fn row_8_a_sensor_that_holds_its_last_sample_in_motion() {
    for order in [LIFT, LOWER] {
        let mut rig = Rig::moving(order);
        let mut held = None;
        let cut = rig.cut_after(order, |inputs, _| {
            held = held.or(inputs.rocker_angle);
            inputs.rocker_angle = held;
            hangs(inputs);
        });
        assert_eq!(rig.envelope.tripped(), Some(Trip::AngleFrozen), "{order:?}");
        assert!(
            cut.is_some_and(|cut| cut <= IN_MOTION_MS),
            "{order:?}: {cut:?}"
        );
    }
}

// REQ-SAFE-04
#[test]
fn row_10_a_sensor_that_sticks_in_motion_and_keeps_its_noise() {
    for order in [LIFT, LOWER] {
        let mut rig = Rig::moving(order);
        rig.speed = 0;
        let cut = rig.cut_after(order, |inputs, _| hangs(inputs));
        assert_eq!(
            rig.envelope.tripped(),
            Some(Trip::NotFollowing),
            "{order:?}"
        );
        assert!(
            cut.is_some_and(|cut| cut <= IN_MOTION_MS),
            "{order:?}: {cut:?}"
        );
    }
}

/// A hitch in motion owes half of its speed, and so more than one that has just started.
#[test]
fn a_hitch_that_stops_is_cut_sooner_than_one_that_has_just_started() {
    let margin = SAFETY.following_margin.0;
    for (order, less, way) in [
        (Order::Lift(2_300), Order::Lift(2_300 - margin), 1),
        (Order::Lower(2_300), Order::Lower(2_300 - margin), -1),
    ] {
        let mut rig = Rig::armed_at(90_000 - way * 25_000);
        rig.speed = way * (given_deg(order.currents()) * 1e3) as i32;
        while (90_000 - rig.angle) * way > 0 {
            rig.step_with(order, hangs);
        }
        rig.speed = 0;
        let cut = rig.cut_after(order, |inputs, _| hangs(inputs));
        assert_eq!(rig.envelope.tripped(), Some(Trip::NotFollowing));
        let owed_um_per_ms = started_um_per_ms(less.currents());
        let started_ms = f64::from(SAFETY.following_allowance.0) / owed_um_per_ms;
        let cut_ms = f64::from(cut.unwrap());
        assert!(
            cut_ms < 0.9 * started_ms,
            "{order:?}: {cut_ms}, {started_ms} ms"
        );
    }
}

/// What its valve gives it is given behind the lags of a slow spool.
#[test]
fn a_hitch_that_has_just_started_may_stand_for_as_long_as_its_spool_is_slow() {
    for order in [LIFT, LOWER] {
        let way = if order == LIFT { 1 } else { -1 };
        let mut rig = Rig::armed();
        let slow = if way > 0 {
            Order::Lift(1_326)
        } else {
            Order::Lower(1_199)
        };
        rig.speed = way * 2;
        rig.run(slow, 300);
        rig.speed = 0;
        rig.run(slow, 100);
        // Only the share of what the valve gives.
        let safety = SafetyParameters {
            following_speed: MicrometrePerSecond(0),
            ..SAFETY
        };
        let cut = (0..2_000).find(|_| {
            let limits = Limits {
                safety: &safety,
                ..limits()
            };
            rig.step_within(limits, order, hangs) == CoilCurrents::OFF
        });
        let (lift, lower) = (order.currents().lift, order.currents().lower);
        let less = |current: MilliAmp| MilliAmp((current - SAFETY.following_margin).0.max(0));
        let less = CoilCurrents {
            lift: less(lift),
            lower: less(lower),
        };
        let share = f64::from(SAFETY.following_share.0) * 1e-3;
        let owed_ms =
            f64::from(SAFETY.following_allowance.0) / (share * given_deg(less) * um_per_deg());
        // A tenth: it owes a bit while they rise.
        let least_ms = 0.9 * (owed_ms + 2.0 * f64::from(SAFETY.started_lag.0));
        assert!(
            f64::from(cut.unwrap()) >= least_ms,
            "{order:?}: {cut:?}, {least_ms} ms"
        );
    }
}

/// A load that swings, or is taken up from the ground, stands for up to 0.1 s.
#[test]
fn a_hitch_that_has_just_started_may_stand_for_110_ms() {
    for (order, slow, way) in [
        (LIFT, Order::Lift(1_326), 1),
        (LOWER, Order::Lower(1_199), -1),
    ] {
        let mut rig = Rig::armed();
        rig.speed = way * 2;
        rig.run(slow, 300);
        rig.speed = 0;
        rig.run(slow, 100);
        let cut = rig.cut_after(order, |inputs, _| hangs(inputs));
        assert!(
            cut.is_some_and(|cut| (110..160).contains(&cut)),
            "{order:?}: {cut:?} ms"
        );
    }
}

#[test]
fn a_controller_that_takes_back_current_does_not_hide_a_frozen_sensor() {
    let mut rig = Rig::moving(LIFT);
    rig.speed = 0;
    let cut = (1..=IN_MOTION_MS + 10)
        .find(|&step| rig.step_with(Order::Lift(2_500 - 15 * step), |_| {}) == CoilCurrents::OFF);
    assert!(cut.is_some());
    assert_eq!(rig.envelope.tripped(), Some(Trip::NotFollowing));
}

/// Travel that a hitch of the nominal calibration is given at 90 degrees by a current in a step, degree.
fn given_deg(passed: CoilCurrents) -> f64 {
    let (table, current) = if passed.lift > MilliAmp(0) {
        (&NOMINAL.lift, passed.lift)
    } else {
        (&NOMINAL.lower, passed.lower)
    };
    let piston = piston_speed(table.flow(current), NOMINAL.hydraulics.piston_area);
    f64::from(piston.0) * 1e-3 / um_per_deg()
}

/// Piston travel that a hitch in motion owes in a step for currents less the margin, at 90 degrees, micrometre.
fn started_um_per_ms(less: CoilCurrents) -> f64 {
    let given = given_deg(less) * um_per_deg();
    let least = (0.5 * given).min(f64::from(SAFETY.following_speed.0) * 1e-3);
    least.max(f64::from(SAFETY.following_share.0) * 1e-3 * given)
}

/// Piston travel for a degree at 90 degrees, micrometre.
fn um_per_deg() -> f64 {
    let travel = |angle| f64::from(NOMINAL.linkage.travel(MilliDegree(angle)).0);
    (travel(91_000) - travel(89_000)) / 2.0
}

/// Given so much by the currents until it trips, whatever is asked for.
#[test]
fn a_sensor_that_was_frozen_before_the_coil_came_on_trips() {
    for order in [
        LIFT,
        LOWER,
        Order::Lift(3_500),
        Order::Lower(3_500),
        Order::Lift(1_500),
        Order::Lower(1_400),
    ] {
        let mut rig = Rig::armed();
        let mut travel_deg = 0.0;
        for _ in 0..AT_THE_START_MS {
            let passed = rig.step_with(order, |inputs| {
                inputs.rocker_angle = Some(MilliDegree(90_000));
                hangs(inputs);
            });
            travel_deg += given_deg(passed);
        }
        assert_eq!(rig.envelope.tripped(), Some(Trip::AngleFrozen), "{order:?}");
        let most_deg = f64::from(SAFETY.onset_debt.0) * 1e-3 + 0.5;
        assert!(travel_deg <= most_deg, "{order:?}: {travel_deg} deg");
    }
}

/// Before motion is seen the currents spend a budget of travel; then they give the onset speed and no more.
#[test]
fn a_hitch_that_has_yet_to_start_gets_no_more_than_the_onset_speed() {
    for (order, onset) in [
        (Order::Lift(3_500), SAFETY.lift_onset_speed),
        (Order::Lower(3_500), SAFETY.lower_onset_speed),
    ] {
        let mut rig = Rig::armed();
        let (mut travel_deg, mut limited_steps) = (0.0, 0);
        let budget_deg = f64::from(SAFETY.onset_budget.0) * 1e-3;
        for _ in 0..5_000 {
            if rig.envelope.tripped().is_some() {
                break;
            }
            let spent = travel_deg >= budget_deg;
            let step_deg = given_deg(rig.step_with(order, hangs));
            travel_deg += step_deg;
            if spent {
                let most_deg = f64::from(onset.0) * 1e-3 / um_per_deg();
                assert!(step_deg <= 1.02 * most_deg, "{order:?}: {step_deg} deg");
                assert!(rig.envelope.holds_back() || step_deg == 0.0);
                limited_steps += 1;
            }
        }
        assert!(limited_steps > 0, "{order:?}");
    }
}

/// White noise of 0.1 degree, one sigma, on every sample: that of a coarse sensor that is still healthy.
fn with_noise(random: &mut fastrand::Rng, inputs: &mut Inputs) {
    // A sum of twelve is as good as normal here.
    let normal: f64 = (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
    let noise = MilliDegree((100.0 * normal) as i32);
    inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + noise);
}

#[test]
fn noise_of_a_sensor_is_no_motion() {
    for (order, onset) in [
        (Order::Lift(3_500), SAFETY.lift_onset_speed),
        (Order::Lower(3_500), SAFETY.lower_onset_speed),
    ] {
        for seed in 1..=50 {
            let mut random = fastrand::Rng::with_seed(seed);
            let mut rig = Rig::armed();
            let mut last_deg = 0.0;
            for _ in 0..AT_THE_START_MS {
                let passed = rig.step_with(order, |inputs| {
                    with_noise(&mut random, inputs);
                    hangs(inputs);
                });
                if passed != CoilCurrents::OFF {
                    last_deg = given_deg(passed);
                }
            }
            let most_deg = f64::from(onset.0) * 1e-3 / um_per_deg();
            let case = format!("{order:?}, seed {seed}: {last_deg} deg");
            assert!(last_deg <= 1.1 * most_deg, "{case}");
            assert_eq!(rig.envelope.tripped(), Some(Trip::NotFollowing), "{case}");
        }
    }
}

#[test]
fn noise_of_a_sensor_hides_no_motion_of_two_degrees() {
    for (order, way) in [(Order::Lift(3_500), 1), (Order::Lower(3_500), -1)] {
        for seed in 1..=50 {
            let mut random = fastrand::Rng::with_seed(seed);
            let mut rig = Rig::armed();
            // Slow enough that what the current gives would spend the onset budget.
            rig.speed = way * 20;
            for step in 1..=400 {
                rig.step_with(order, |inputs| {
                    with_noise(&mut random, inputs);
                    hangs(inputs);
                });
                let held_back = rig.envelope.holds_back() && 20 * step > 2_000;
                assert!(!held_back, "{order:?}, seed {seed}: after {step} ms");
            }
            assert_eq!(rig.passed, order.currents(), "{order:?}, seed {seed}");
        }
    }
}

#[test]
fn a_command_within_its_limits_is_not_held_back() {
    for order in [LIFT, LOWER] {
        let mut rig = Rig::armed();
        assert!(!rig.envelope.holds_back(), "no command");
        rig.run(order, 1);
        assert!(!rig.envelope.holds_back(), "{order:?}, within the budget");
    }
    let (lift, lower) = (SAFETY.lift_current_limit.0, SAFETY.lower_current_limit.0);
    for (full, more) in [
        (Order::Lift(lift), Order::Lift(lift + 1)),
        (Order::Lower(lower), Order::Lower(lower + 1)),
    ] {
        let mut rig = Rig::moving(full);
        rig.run(full, 1);
        assert!(!rig.envelope.holds_back(), "{full:?}");
        rig.run(more, 1);
        assert!(rig.envelope.holds_back(), "{more:?}");
    }
}

#[test]
fn a_coil_that_need_not_move_the_hitch_owes_nothing() {
    // 0.2 A above the thresholds of the calibration.
    for order in [Order::Rest, Order::Lift(1_326), Order::Lower(1_199)] {
        assert_eq!(still(90_000, order, 10_000, hangs).0, None, "{order:?}");
    }
}

#[test]
fn a_hitch_at_an_end_of_its_travel_owes_nothing() {
    assert_eq!(still(132_000, LIFT, 5_000, hangs).0, None);
    assert_eq!(still(48_000, LOWER, 5_000, hangs), (None, false));
    assert_eq!(
        still(132_000, LOWER, 5_000, hangs).0,
        Some(Trip::NotFollowing)
    );
    assert_eq!(
        still(48_000, LIFT, 5_000, hangs).0,
        Some(Trip::NotFollowing)
    );
}

#[test]
fn a_hitch_on_the_ground_or_behind_the_relief_valve_owes_nothing() {
    let lies = |inputs: &mut Inputs| inputs.cylinder_pressure = Some(MilliBar(500));
    assert_eq!(still(90_000, LOWER, 5_000, lies), (None, false));
    let overloaded = |inputs: &mut Inputs| inputs.pump_pressure = Some(MilliBar(154_000));
    assert_eq!(still(90_000, LIFT, 5_000, overloaded), (None, false));
}

#[test]
fn without_a_pressure_a_hitch_that_may_have_landed_is_cut_off_without_a_fault() {
    let mut rig = Rig::moving(LOWER);
    rig.speed = 0;
    let cut = rig.cut_after_landing(LOWER);
    assert!(cut.is_some_and(|cut| cut <= IN_MOTION_MS), "{cut:?}");
    assert!(rig.envelope.has_ground_contact());
    assert_eq!(rig.run(LOWER, 5_000), CoilCurrents::OFF, "stays off");
    assert_eq!(rig.envelope.tripped(), None);
    assert!(rig.envelope.has_ground_contact());
    rig.run(Order::Rest, 1);
    assert!(!rig.envelope.has_ground_contact());
    assert_ne!(rig.run(LOWER, 1), CoilCurrents::OFF, "the command was off");
}

/// Soft ground takes the weight off the oil slowly.
#[test]
fn a_hitch_whose_pressure_has_fallen_by_half_may_have_landed() {
    for (order, bar_1000, lands) in [
        (LOWER, 7_500, false),
        (LOWER, 7_499, true),
        (LIFT, 7_499, false),
    ] {
        let mut rig = Rig::moving(order);

        rig.step_with(order, hangs);
        rig.speed = 0;
        let cut = (0..500).find(|_| {
            let passed = rig.step_with(order, |inputs| {
                inputs.cylinder_pressure = Some(MilliBar(bar_1000));
            });
            passed == CoilCurrents::OFF
        });
        let case = (order, bar_1000);
        assert!(cut.is_some_and(|cut| cut <= 2 * IN_MOTION_MS), "{case:?}");
        assert_eq!(rig.envelope.has_ground_contact(), lands, "{case:?}");
        let fault = (!lands).then_some(Trip::NotFollowing);
        assert_eq!(rig.envelope.tripped(), fault, "{case:?}");
    }
}

/// A quarter of the allowance is motion, even if more is owed.
#[test]
fn a_hitch_at_half_of_the_following_speed_shows_a_sensor_that_lives() {
    for (order, way) in [(LIFT, 1), (LOWER, -1)] {
        let mut rig = Rig::armed();
        rig.speed = way * 2;
        assert!(2.0 * um_per_deg() < 0.5 * f64::from(SAFETY.following_speed.0));
        for step in 0..3_000 {
            let passed = rig.step_with(order, hangs);
            assert_ne!(passed, CoilCurrents::OFF, "{order:?}, {step}");
        }
    }
}

#[test]
fn a_load_that_swings_shows_a_sensor_that_lives() {
    let mut rig = Rig::moving(LIFT);
    // To and fro by a degree within 100 ms, and no further.
    for step in 0..2_000 {
        rig.speed = if step % 100 < 50 { -20 } else { 20 };
        assert_ne!(rig.step_with(LIFT, |_| {}), CoilCurrents::OFF, "{step}");
    }
}
