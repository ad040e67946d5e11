//! Limits of the set point: by function and lever, and by the speed of the valves.

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{MilliDegree, MilliDegreePerSecond};
use hitch_quantities::{Calibration, Function};

use super::function_loop::Errors;
use super::selector::Choice;
use super::situation::Situation;

/// The highest set point of a function.
pub fn highest(
    function: Option<Function>,
    situation: &Situation,
    calibration: &Calibration,
) -> MilliDegree {
    match function {
        Some(Function::Depth) => {
            (situation.lever + calibration.depth.margin).min(situation.highest)
        }
        _ => situation.highest,
    }
}

/// The lowest set point of a function.
pub fn lowest(
    function: Option<Function>,
    lever: MilliDegree,
    calibration: &Calibration,
) -> MilliDegree {
    let floor = match function {
        Some(Function::DepthLimit) => lever,
        Some(Function::Depth) => lever - calibration.depth.margin,
        _ => lever - calibration.draft.margin,
    };
    floor.max(calibration.position.lower_limit)
}

/// Where quick engagement lowers to: as deep as the selected function may, and without one to the lower limit. It stays where it
/// is while the sensors are in doubt.
pub fn deepest(choice: &Choice, errors: Option<Errors>, calibration: &Calibration) -> MilliDegree {
    match (choice.function, errors) {
        (Function::Position, _) => calibration.position.lower_limit,
        (_, None) => choice.present,
        (function, Some(_)) => {
            lowest(Some(function), choice.lever, calibration).min(choice.present)
        }
    }
}

/// The set point `wanted`, no further from the present one than the valves move the hitch in a step.
pub fn reachable(
    present: MilliDegree,
    wanted: MilliDegree,
    situation: &Situation,
    calibration: &Calibration,
) -> MilliDegree {
    let one_degree = MilliDegreePerSecond(1_000);
    let per_degree = calibration
        .linkage
        .piston_speed(situation.angle, one_degree);
    let per_degree = Divisor::at_least_one(per_degree.0);
    // Degrees in a second are millidegrees in a millisecond.
    let [up, down] = situation
        .valve_speeds
        .map(|speed| MilliDegree(per_degree.divide(speed.0)));
    wanted.limited(present - down, present + up)
}
