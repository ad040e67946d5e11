//! Position control: which lever it follows, and how fast it goes.

use hitch_control::estimation::motion_observer::MotionObserver;
use hitch_control::motion::position::PositionControl;
use hitch_control::valve::closing::ClosingCurves;
use hitch_control::valve::drop_scale::{DropReference, DropScale};
use hitch_control::valve::phase::{Demand, Direction, Phase};
use hitch_quantities::calibration::design_parameters::PositionParameters;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, MilliAmp, MilliBar, MilliDegree};
use hitch_quantities::{Calibration, CoilCurrents};

const PARAMETERS: PositionParameters = PositionParameters::NOMINAL;
const ASKED: i32 = 90_000;

fn follow(position: &mut PositionControl, lever: i32, moving: bool) -> bool {
    let limit = PARAMETERS.upper_limit;
    position.follow(MilliDegree(lever), limit, moving, &PARAMETERS)
}

fn set_point(position: &PositionControl) -> i32 {
    position.set_point(MilliDegree(0)).0
}

fn asked() -> PositionControl {
    let mut position = PositionControl::default();
    assert!(follow(&mut position, ASKED, false));
    position
}

#[test]
fn a_lever_inside_its_dead_band_makes_no_new_set_point() {
    let band = PARAMETERS.lever_deadband.0;
    for sign in [-1, 1] {
        let mut position = asked();
        assert!(!follow(&mut position, ASKED + sign * band, false));
        assert_eq!(set_point(&position), ASKED);
        let beyond = ASKED + sign * (band + 1);
        assert!(follow(&mut position, beyond, false));
        assert_eq!(set_point(&position), beyond);
    }
}

#[test]
fn a_small_movement_of_the_lever_counts_on_the_way_and_nowhere_else() {
    let near = ASKED + PARAMETERS.lever_deadband.0;
    let mut position = asked();
    follow(&mut position, near, false);
    assert_eq!(set_point(&position), ASKED, "at rest");
    follow(&mut position, near, true);
    assert_eq!(set_point(&position), near, "on the way");
    assert!(!position.has_arrived());
    let here = Micrometre(0);
    assert_eq!(position.reason_to_move(here, here, &PARAMETERS), None);
    assert!(position.has_arrived());
    follow(&mut position, ASKED, true);
    assert_eq!(set_point(&position), near, "brought back");
}

#[test]
fn a_hitch_within_the_restart_band_of_its_set_point_stays() {
    let band = PARAMETERS.restart_band.0;
    for target in [-300_000, 0, 300_000] {
        for (off, stays) in [(0, true), (band, true), (band + 1, false)] {
            for off in [off, -off] {
                let rest = Micrometre(target + off);
                let reason = asked().reason_to_move(Micrometre(target), rest, &PARAMETERS);
                assert_eq!(reason.is_none(), stays, "{target} um, {off} um off");
            }
        }
    }
}

#[test]
fn bands_that_a_tool_narrows_under_a_resting_hitch_wait_for_the_lever() {
    let narrow = PositionParameters {
        lever_deadband: MilliDegree(0),
        restart_band: Micrometre(0),
        ..PARAMETERS
    };
    let (target, rest) = (Micrometre(0), Micrometre(PARAMETERS.restart_band.0));
    let near = MilliDegree(ASKED + PARAMETERS.lever_deadband.0);
    let mut position = asked();
    assert!(!position.follow(near, narrow.upper_limit, false, &narrow));
    assert_eq!(position.reason_to_move(target, rest, &narrow), None);
    let moved = MilliDegree(near.0 + 1);
    assert!(position.follow(moved, narrow.upper_limit, false, &narrow));
    assert_ne!(position.reason_to_move(target, rest, &narrow), None);
}

#[test]
fn a_place_that_was_accepted_is_kept_until_the_lever_moves() {
    let far = (Micrometre(0), Micrometre(50_000));
    let mut position = asked();
    assert_ne!(position.reason_to_move(far.0, far.1, &PARAMETERS), None);
    position.accept();
    assert_eq!(position.reason_to_move(far.0, far.1, &PARAMETERS), None);
    follow(&mut position, ASKED + PARAMETERS.lever_deadband.0, false);
    assert_eq!(position.reason_to_move(far.0, far.1, &PARAMETERS), None);
    assert!(follow(&mut position, ASKED + 10_000, false));
    assert_ne!(position.reason_to_move(far.0, far.1, &PARAMETERS), None);
}

/// Demand of a hitch towards `target`, with the reference's pressure drop times `drop_percent`.
fn demand(motion: &MotionObserver, target: i32, phase: Phase, drop_percent: i32) -> Demand {
    let calibration = Calibration::nominal();
    let reference = calibration.hydraulics.reference_drop;
    let drop = MilliBar(reference.0 / 100 * drop_percent);
    let scale = DropScale::new(&DropReference::new(reference), drop);
    let closing = ClosingCurves::of(&calibration);
    let target = Micrometre(target);
    PositionControl::default().demand(target, phase, motion, &closing, scale, &calibration)
}

/// At 0 and at rest.
fn resting() -> MotionObserver {
    resting_at(0)
}

/// At rest.
fn resting_at(at_um: i32) -> MotionObserver {
    let mut motion = MotionObserver::default();
    motion.update(
        Micrometre(at_um),
        None,
        Phase::Holding,
        &Calibration::nominal().motion,
    );
    motion
}

#[test]
fn a_demand_is_the_same_wherever_the_way_begins() {
    for way in [-200_000, -20_000, -2_000, 2_000, 20_000, 200_000] {
        let from = |at| demand(&resting_at(at), at + way, Phase::Holding, 100);
        let direction = Direction::of(way);
        assert_eq!(from(0).direction, direction);
        for at in [-300_000, 300_000] {
            assert_eq!(from(at), from(0), "{way} um from {at} um");
        }
    }
}

#[test]
fn no_move_is_faster_than_its_limit_nor_slower_than_creeping_until_it_is_there() {
    for (direction, limit) in [(1, PARAMETERS.lift_speed), (-1, PARAMETERS.lower_speed)] {
        let speed = |way: i32| demand(&resting(), direction * way, Phase::Holding, 100).speed;
        assert_eq!(speed(1_000_000), limit);
        let band = PARAMETERS.stop_band.0;
        assert_eq!(speed(band), MicrometrePerSecond(0));
        let speeds: Vec<_> = (band + 1..200_000).step_by(100).map(speed).collect();
        assert!(speeds.is_sorted() && speeds[0] >= PARAMETERS.creep_speed);
    }
}

#[test]
fn a_move_keeps_its_direction_when_its_set_point_is_passed() {
    for direction in [Direction::Lift, Direction::Lower] {
        let phase = Phase::Moving {
            direction,
            speed: PARAMETERS.creep_speed,
        };
        for target in [-50_000, 50_000] {
            assert_eq!(demand(&resting(), target, phase, 100).direction, direction);
        }
    }
}

#[test]
fn ramps_of_lowering_go_with_the_root_of_the_pressure_drop_and_those_of_lifting_do_not() {
    let ramp = |target, drop| {
        f64::from(
            demand(&resting(), target, Phase::Holding, drop)
                .acceleration
                .0,
        )
    };
    for (drop, share) in [(25, 0.5), (100, 1.0), (400, 2.0)] {
        let found = ramp(-50_000, drop) / f64::from(PARAMETERS.lower_acceleration.0);
        assert!((found / share - 1.0).abs() < 0.01, "{drop} %: {found}");
        assert_eq!(
            ramp(50_000, drop),
            f64::from(PARAMETERS.lift_acceleration.0)
        );
    }
    // The deceleration too: the speed at a distance goes with its root.
    let speed = |drop| f64::from(demand(&resting(), -20_000, Phase::Holding, drop).speed.0);
    let found = speed(25) / speed(100);
    assert!((found * found / 0.5 - 1.0).abs() < 0.15, "{found}");
}

#[test]
fn a_load_that_swings_is_lifted_with_gentle_ramps_and_lowered_as_any_other() {
    let (steady, mut swinging) = (resting(), resting());
    swinging.confirm_oscillation();
    let lifted = |motion: &MotionObserver| demand(motion, 20_000, Phase::Holding, 100);
    let (usual, gentle) = (lifted(&steady), lifted(&swinging));
    assert_eq!(usual.acceleration, PARAMETERS.lift_acceleration);
    assert_eq!(gentle.acceleration, PARAMETERS.swinging_acceleration);
    // The speed at a distance goes with the root of the deceleration.
    assert!(gentle.speed < usual.speed, "{gentle:?}, {usual:?}");
    let lowered = |motion: &MotionObserver| demand(motion, -20_000, Phase::Holding, 100);
    assert_eq!(lowered(&swinging), lowered(&steady));
}

#[test]
fn the_coil_is_cut_where_the_closing_valve_carries_the_hitch_to_its_set_point() {
    let calibration = Calibration::nominal();
    let reference = calibration.hydraulics.reference_drop;
    let scale = DropScale::new(&DropReference::new(reference), reference);
    let closing = ClosingCurves::of(&calibration);
    let phase = Phase::Moving {
        direction: Direction::Lift,
        speed: PARAMETERS.lift_speed,
    };
    let currents = CoilCurrents {
        lift: MilliAmp(2_000),
        lower: MilliAmp(0),
    };
    let (mut motion, mut at_um) = (resting(), 0);
    for _ in 0..400 {
        motion.apply_currents(currents, false, scale, &calibration);
        at_um += motion.model_speed().0 / 1_000;
        motion.update(Micrometre(at_um), None, phase, &calibration.motion);
    }
    let stop_prediction = motion.stop_prediction(&calibration.hydraulics);
    let cut = stop_prediction
        .predicted_stop_after_cut(motion.closing_share(&closing))
        .0;
    let rest = stop_prediction.predicted_stop().0;
    let band = PARAMETERS.stop_band.0;
    assert!(cut + band < rest, "cut {cut}, ramp {rest}");
    let speed = |target| demand(&motion, target, phase, 100).speed;
    assert_eq!(speed(cut + band), MicrometrePerSecond(0));
    // The ramp would be over here, so it creeps.
    assert_eq!(speed(cut + band + 1), PARAMETERS.creep_speed);
}
