//! Scenarios of `hitch tune`: those of `hitch loop` with values to tune, and what is driven for them.

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use hitch_plant::Model;
use hitch_quantities::ValidCalibration;

use crate::commands::loop_scenario::LoopScenario;
use hitch_results::closed_loop::{self, Move, OIL_TEMPERATURE_C, Press, Scenario};
use hitch_results::field_loop::scenario::FieldScenario;

/// Parses a scenario that has values to tune.
pub fn tunable() -> impl TypedValueParser<Value = LoopScenario> {
    let scenarios = LoopScenario::value_variants().iter();
    let tunable = scenarios.filter(|scenario| has_values(**scenario));
    PossibleValuesParser::new(tunable.filter_map(named))
        .try_map(|name| LoopScenario::from_str(&name, false))
}

fn has_values(scenario: LoopScenario) -> bool {
    !matches!(
        scenario,
        LoopScenario::QuickLift | LoopScenario::Field(FieldScenario::Headland)
    )
}

fn named(scenario: &LoopScenario) -> Option<PossibleValue> {
    let value = scenario.to_possible_value()?;
    Some(match scenario {
        LoopScenario::Moves(Scenario::Tuning) => value.help(
            "A small set of moves of 2 to 80 degrees with cold, warm and hot oil, and the presses of `rate`",
        ),
        _ => value,
    })
}

/// Moves of the lever in a scenario.
pub fn moves(scenario: LoopScenario, model: &Model, loads_kg: Option<&[f64]>) -> Vec<Move> {
    match scenario {
        LoopScenario::Moves(scenario) => scenario.moves(model, loads_kg),
        _ => Vec::new(),
    }
}

/// Presses of the button, at the speeds of a calibration. The set of moves for tuning has them too.
pub fn presses(
    scenario: LoopScenario,
    model: &Model,
    calibration: &ValidCalibration,
    loads_kg: Option<&[f64]>,
) -> Vec<Press> {
    match scenario {
        LoopScenario::Rate | LoopScenario::Moves(Scenario::Tuning) => {
            closed_loop::presses(model, calibration, loads_kg, &[OIL_TEMPERATURE_C])
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_of_moves_can_be_tuned() {
        for scenario in Scenario::value_variants() {
            assert!(has_values(LoopScenario::Moves(*scenario)));
        }
    }
}
