//! Scenarios of `hitch loop`: sets of moves, and the buttons.

use std::fmt;

use clap::ValueEnum;
use clap::builder::PossibleValue;

use hitch_results::closed_loop::Scenario;
use hitch_results::field_loop::scenario::FieldScenario;

/// What is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoopScenario {
    /// Moves of the lever.
    Moves(Scenario),
    /// The external button.
    Rate,
    /// The button of quick lift.
    QuickLift,
    /// A function in the field.
    Field(FieldScenario),
}

impl Default for LoopScenario {
    fn default() -> Self {
        Self::Moves(Scenario::Moves)
    }
}

impl ValueEnum for LoopScenario {
    fn value_variants<'a>() -> &'a [Self] {
        &[
            Self::Moves(Scenario::Moves),
            Self::Moves(Scenario::Quick),
            Self::Moves(Scenario::Fine),
            Self::Moves(Scenario::Ends),
            Self::Moves(Scenario::Tuning),
            Self::Moves(Scenario::Limits),
            Self::Rate,
            Self::QuickLift,
            Self::Field(FieldScenario::Draft),
            Self::Field(FieldScenario::Mix),
            Self::Field(FieldScenario::Slip),
            Self::Field(FieldScenario::Depth),
            Self::Field(FieldScenario::Transport),
            Self::Field(FieldScenario::Headland),
        ]
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        Some(match self {
            Self::Field(scenario) => return scenario.to_possible_value(),
            Self::Moves(scenario) => return scenario.to_possible_value(),
            Self::Rate => PossibleValue::new("rate").help(
                "The external button at 20, 50 and 100 % of its fastest speed: steady speed, delays, overshoot",
            ),
            Self::QuickLift => PossibleValue::new("quick-lift")
                .help("Quick lift from three positions of the lever, and back to it"),
        })
    }
}

impl fmt::Display for LoopScenario {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&typed(self))
    }
}

/// A value as it is typed on the command line.
pub fn typed(value: &impl ValueEnum) -> String {
    let value = value.to_possible_value();
    value.map_or_else(String::new, |value| value.get_name().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_set_of_moves_can_be_driven() {
        for scenario in Scenario::value_variants() {
            assert!(LoopScenario::value_variants().contains(&LoopScenario::Moves(*scenario)));
        }
    }
}
