//! Set points of draft and depth by one dial: the selected function takes the one that it regulates.

use hitch_quantities::Inputs;
use hitch_quantities::calibration::Calibration;
use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Newton, PerMille};

/// Adds the set points of a dial to the inputs of a step: open, it is the nominal force of both draft pins, and the range
/// of the depth sensor over half of its supply. Without a dial, or with a broken wire, there is no set point, and the lever
/// is the position.
#[must_use]
pub fn with_set_points(
    inputs: Inputs,
    dial: Option<PerMille>,
    calibration: &Calibration,
) -> Inputs {
    let (draft, depth) = (&calibration.draft, &calibration.depth);
    let force: Newton = draft.left_span + draft.right_span;
    // The span is that of a quarter of the supply.
    let range = depth.span.magnitude() + depth.span.magnitude();
    Inputs {
        draft_set_point: dial.map(|dial| force.scaled(dial.0, Divisor::THOUSAND)),
        depth_set_point: dial.map(|dial| range.scaled(dial.0, Divisor::THOUSAND)),
        ..inputs
    }
}

#[cfg(test)]
mod tests {
    use hitch_quantities::units::Micrometre;

    use super::*;

    #[test]
    fn an_open_dial_is_the_nominal_force_of_both_pins_and_the_range_of_the_depth_sensor() {
        let mut calibration = Calibration::nominal();
        calibration.draft.left_span = Newton(60_000);
        calibration.depth.span = Micrometre(-300_000);
        for (dial, draft, depth) in [(0, 0, 0), (250, 25_000, 150_000), (1_000, 100_000, 600_000)] {
            let inputs = with_set_points(Inputs::default(), Some(PerMille(dial)), &calibration);
            assert_eq!(inputs.draft_set_point, Some(Newton(draft)));
            assert_eq!(inputs.depth_set_point, Some(Micrometre(depth)));
        }
        let inputs = with_set_points(Inputs::default(), None, &calibration);
        assert_eq!(
            (inputs.draft_set_point, inputs.depth_set_point),
            (None, None)
        );
    }
}
