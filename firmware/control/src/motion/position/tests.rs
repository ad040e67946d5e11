use super::*;
use crate::valve::drop_scale::DropReference;

#[test]
fn the_profile_is_the_constant_deceleration_it_says() {
    let (deceleration, gain) = (MillimetrePerSecondSquared(1_200), PerSecond(20));
    let mut last = MicrometrePerSecond::ZERO;
    for remaining in 0..200_000 {
        let speed = approach_speed(Micrometre(remaining), deceleration, gain);
        assert!(speed >= last, "falls at {remaining} um");
        let (r, a, k) = (f64::from(remaining) * 1e-6, 1.2, 20.0);
        let exact = if r <= a / (k * k) {
            k * r
        } else {
            (2.0 * a * (r - a / (2.0 * k * k))).sqrt()
        };
        assert!(
            (f64::from(speed.0) * 1e-6 - exact).abs() < 1e-4 * exact + 2e-6,
            "{remaining} um"
        );
        last = speed;
    }
}

#[test]
fn cutting_the_coil_at_the_slowest_approach_leaves_a_load_on_aerated_oil_where_it_is() {
    // A load that is stopped at once swings on by its speed over its frequency; 1.75 mm are a degree.
    const SOFTEST_HZ: f64 = 5.0;
    let creep_mm_per_s = f64::from(PositionParameters::NOMINAL.creep_speed.0) * 1e-3;
    let swing_mm = creep_mm_per_s / (core::f64::consts::TAU * SOFTEST_HZ);
    assert!(swing_mm / 1.75 <= 0.1, "{swing_mm} mm");
}

#[test]
fn a_move_that_ended_elsewhere_is_made_good_slowly_but_not_as_slowly_as_a_move_ends() {
    let parameters = PositionParameters::NOMINAL;
    let (fast, creep) = (
        parameters.lift_speed,
        creep_multiple(CORRECTION_FACTOR, &parameters),
    );
    assert!(creep > parameters.creep_speed && creep.0 < fast.0 / 10);
    let demand = Demand {
        direction: Direction::Lift,
        speed: fast,
        acceleration: parameters.lift_acceleration,
    };
    let mut position = PositionControl::default();
    let mut moved = |reason, rests| {
        assert_eq!(position.start(), reason);
        if rests {
            let here = Micrometre::ZERO;
            assert_eq!(position.reason_to_move(here, here, &parameters), None);
        }
        position.limit_approach(demand, fast, &parameters).speed
    };
    assert_eq!(moved(MoveReason::SetPoint, false), fast);
    assert_eq!(moved(MoveReason::Drift, true), creep, "ended elsewhere");
    assert_eq!(moved(MoveReason::Drift, false), fast, "left its place");
}

#[test]
fn a_correction_that_went_too_far_makes_the_next_one_end_earlier() {
    let parameters = PositionParameters::NOMINAL;
    let mut position = PositionControl::default();
    let mut beyond = |direction, away| {
        position.begin_correction(direction, Micrometre(away), &parameters);
        position.beyond.0
    };
    let most = (parameters.restart_band - parameters.stop_band).0;
    assert_eq!(beyond(Direction::Lift, 700), 0, "nothing known");
    assert_eq!(beyond(Direction::Lift, 700), 0, "a leak goes on");
    assert_eq!(beyond(Direction::Lower, -300), 300, "too far");
    assert_eq!(beyond(Direction::Lower, -200), 100, "not far enough");
    // A hitch that has to be corrected has more left than the stop band.
    assert_eq!(beyond(Direction::Lift, 5_000), most);
    position.follow(
        parameters.lower_limit,
        parameters.upper_limit,
        false,
        &parameters,
    );
    assert_eq!(position.beyond, Micrometre::ZERO, "another set point");
}

#[test]
fn a_move_that_has_slowed_down_to_its_end_stays_slow_until_the_next_one() {
    let parameters = PositionParameters::NOMINAL;
    let (fast, end) = (
        parameters.lift_speed,
        creep_multiple(FINAL_APPROACH_FACTOR, &parameters),
    );
    let limit_approach = |position: &mut PositionControl, speed| {
        let demand = Demand {
            direction: Direction::Lift,
            speed,
            acceleration: parameters.lift_acceleration,
        };
        position.limit_approach(demand, fast, &parameters).speed
    };
    let (low, high) = (MilliDegree(80_000), MilliDegree(90_000));
    let mut position = PositionControl::default();
    position.follow(low, parameters.upper_limit, false, &parameters);
    position.start();
    for speed in [fast, end + MicrometrePerSecond(1), fast] {
        assert_eq!(limit_approach(&mut position, speed), speed, "under way");
    }
    let slow = parameters.creep_speed;
    for (demanded, given) in [(end, end), (fast, end), (slow, slow), (fast, end)] {
        assert_eq!(limit_approach(&mut position, demanded), given);
    }
    position.follow(high, parameters.upper_limit, true, &parameters);
    assert_eq!(
        limit_approach(&mut position, fast),
        fast,
        "another set point"
    );
    assert_eq!(limit_approach(&mut position, end), end);
    let here = Micrometre::ZERO;
    assert_eq!(position.reason_to_move(here, here, &parameters), None);
    position.start();
    assert_eq!(limit_approach(&mut position, fast), fast, "another move");
}

/// For how long a hitch that stands still `short_of` where its coil is cut is waited for, ms.
fn time_to_cut(position: &mut PositionControl, short_of: Micrometre) -> Option<i32> {
    let calibration = Calibration::nominal();
    let parameters = &calibration.position;
    let closing = ClosingCurves::of(&calibration);
    let drop = calibration.hydraulics.reference_drop;
    let scale = DropScale::new(&DropReference::new(drop), drop);
    let mut motion = MotionObserver::default();
    motion.update(Micrometre::ZERO, None, Phase::Holding, &calibration.motion);
    let phase = Phase::Moving {
        direction: Direction::Lift,
        speed: parameters.creep_speed,
    };
    let target = parameters.stop_band + short_of;
    (0..2_000).find(|_| {
        let demand = position.demand(target, phase, &motion, &closing, scale, &calibration);
        let demand = position.limit_approach(demand, parameters.lower_speed, parameters);
        demand.speed == MicrometrePerSecond::ZERO
    })
}

#[test]
fn a_hitch_that_stands_just_short_of_its_set_point_is_not_waited_for() {
    let mut position = PositionControl::default();
    position.start();
    assert_eq!(time_to_cut(&mut position, Micrometre::ZERO), Some(0));
    let largest = stop_band::largest_extension(&PositionParameters::NOMINAL).0;
    for (short_of, longest_ms) in [(20, 121), (largest, 180)] {
        position.start();
        let waited_ms = time_to_cut(&mut position, Micrometre(short_of)).unwrap();
        assert!((100..=longest_ms).contains(&waited_ms), "{waited_ms} ms");
    }
    position.start();
    assert_eq!(time_to_cut(&mut position, Micrometre(largest + 1)), None);
}

#[test]
fn a_load_that_swings_back_at_the_end_of_a_move_is_waited_for_no_longer() {
    let parameters = PositionParameters::NOMINAL;
    let demand = |speed| Demand {
        direction: Direction::Lift,
        speed,
        acceleration: parameters.lift_acceleration,
    };
    let mut position = PositionControl::default();
    position.start();
    let end = creep_multiple(FINAL_APPROACH_FACTOR, &parameters);
    let _ = position.limit_approach(demand(end), parameters.lower_speed, &parameters);
    for _ in 0..stop_band::delay(&parameters).0 {
        let fast = demand(parameters.lift_speed);
        let _ = position.limit_approach(fast, parameters.lower_speed, &parameters);
    }
    let waited_ms = time_to_cut(&mut position, Micrometre(20)).unwrap();
    assert!(waited_ms <= 10, "{waited_ms} ms more");
}

#[test]
fn a_hitch_that_goes_on_at_its_slowest_gets_where_it_should() {
    let way_per_ms = PositionParameters::NOMINAL.creep_speed.0 / 1_000;
    let end_mm_per_s =
        creep_multiple(FINAL_APPROACH_FACTOR, &PositionParameters::NOMINAL).0 / 1_000;
    let at_end_um = 1_000 * end_mm_per_s / PositionParameters::NOMINAL.approach_gain.0;
    let slowest_um = at_end_um - PositionParameters::NOMINAL.stop_band.0;
    assert!(
        slowest_um / way_per_ms <= stop_band::delay(&PositionParameters::NOMINAL).0,
        "{slowest_um} um"
    );
}

#[test]
fn a_lowering_dial_that_is_opened_during_a_move_is_obeyed() {
    let parameters = PositionParameters::NOMINAL;
    let mut position = PositionControl::default();
    position.start();
    let mut limit_approach = |speed, dial| {
        let demand = Demand {
            direction: Direction::Lower,
            speed,
            acceleration: parameters.lower_acceleration,
        };
        position.limit_approach(demand, dial, &parameters).speed
    };
    let (fast, end) = (
        parameters.lower_speed,
        creep_multiple(FINAL_APPROACH_FACTOR, &parameters),
    );
    for dial in [MicrometrePerSecond::ZERO, parameters.creep_speed, end, fast] {
        assert_eq!(limit_approach(dial, dial), dial);
    }
    assert_eq!(limit_approach(end, fast), end, "its end");
    assert_eq!(limit_approach(fast, fast), end);
}

#[test]
fn extreme_arguments_stay_finite() {
    for remaining in [i32::MIN, -1, 0, 1, i32::MAX] {
        for gain in [1, 200] {
            let speed = approach_speed(
                Micrometre(remaining),
                MillimetrePerSecondSquared(20_000),
                PerSecond(gain),
            );
            assert!(speed >= MicrometrePerSecond::ZERO);
        }
    }
}
