//! Scenarios of `hitch tune`: sets of moves, and the external button.

use std::fmt;

use clap::ValueEnum;
use clap::builder::PossibleValue;
use hitch_plant::Model;
use hitch_quantities::ValidCalibration;

use crate::closed_loop::{self, Move, OIL_TEMPERATURE_C, Press, Scenario};
use crate::commands::loop_scenario::{LoopScenario, typed};
use crate::field_loop::scenario::FieldScenario;

/// What is driven for tuning.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TuneScenario {
    /// Moves of the lever.
    Moves(Scenario),
    /// The external button.
    Rate,
    /// A function in the field.
    Field(FieldScenario),
}

impl TuneScenario {
    /// Moves of the lever.
    pub fn moves(self, model: &Model, loads_kg: Option<&[f64]>) -> Vec<Move> {
        match self {
            Self::Moves(scenario) => scenario.moves(model, loads_kg),
            Self::Rate | Self::Field(_) => Vec::new(),
        }
    }

    /// Presses of the button, at the speeds of a calibration. The set of moves for tuning has them too.
    pub fn presses(
        self,
        model: &Model,
        calibration: &ValidCalibration,
        loads_kg: Option<&[f64]>,
    ) -> Vec<Press> {
        match self {
            Self::Rate | Self::Moves(Scenario::Tuning) => {
                closed_loop::presses(model, calibration, loads_kg, &[OIL_TEMPERATURE_C])
            }
            Self::Moves(_) | Self::Field(_) => Vec::new(),
        }
    }
}

impl ValueEnum for TuneScenario {
    fn value_variants<'a>() -> &'a [Self] {
        &[
            Self::Moves(Scenario::Moves),
            Self::Moves(Scenario::Quick),
            Self::Moves(Scenario::Fine),
            Self::Moves(Scenario::Ends),
            Self::Moves(Scenario::Tuning),
            Self::Moves(Scenario::Limits),
            Self::Rate,
            Self::Field(FieldScenario::Draft),
            Self::Field(FieldScenario::Mix),
            Self::Field(FieldScenario::Slip),
            Self::Field(FieldScenario::Depth),
            Self::Field(FieldScenario::Transport),
        ]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::Moves(Scenario::Tuning) => Some(PossibleValue::new("tuning").help(
                "A small set of moves of 2 to 80 degrees with cold, warm and hot oil, and the presses of `rate`",
            )),
            Self::Moves(scenario) => LoopScenario::Moves(*scenario).to_possible_value(),
            Self::Rate => LoopScenario::Rate.to_possible_value(),
            Self::Field(scenario) => LoopScenario::Field(*scenario).to_possible_value(),
        }
    }
}

impl fmt::Display for TuneScenario {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&typed(self))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_of_moves_can_be_tuned() {
        for scenario in Scenario::value_variants() {
            assert!(TuneScenario::value_variants().contains(&TuneScenario::Moves(*scenario)));
        }
    }
}
