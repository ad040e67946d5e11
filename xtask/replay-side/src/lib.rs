//! Controller and safety envelope of one commit, stepped with words.
//!
//! A paired replay builds this crate with the sources of two commits and sends both the same steps. Fields of inputs and
//! outputs have names: [`description`] lists those of this commit, in the order of their words.
//!
//! Many independent machines are stepped at once ([`Machines`]): a round has one step of each.

use hitch_quantities::calibration::calibration_words::GROUPS;

mod interface;
mod machine;
mod word;

pub use interface::{INPUTS, OUTPUTS, words};
pub use machine::{ENVELOPE_OUTPUTS, Event, HEAD_WORDS, Machines};
pub use word::ABSENT;

/// Words of a step of one machine.
pub const STEP_WORDS: usize = HEAD_WORDS + INPUTS.len();
/// Words of the answer to it.
pub const ANSWER_WORDS: usize = OUTPUTS.len() + ENVELOPE_OUTPUTS.len();

/// The interface of this commit, a line each: `input NAME`, `output NAME`, `parameter NAME NOMINAL MIN MAX`, and `end`.
#[must_use]
pub fn description() -> String {
    let inputs = INPUTS.iter().map(|name| format!("input {name}\n"));
    let outputs = OUTPUTS.iter().chain(&ENVELOPE_OUTPUTS);
    let outputs = outputs.map(|name| format!("output {name}\n"));
    let parameters = GROUPS.iter().flat_map(|group| {
        group.parameters.iter().map(|info| {
            let (nominal, min, max) = (info.nominal, info.min, info.max);
            format!(
                "parameter {}.{} {nominal} {min} {max}\n",
                group.name, info.name
            )
        })
    });
    inputs
        .chain(outputs)
        .chain(parameters)
        .chain(["end\n".to_owned()])
        .collect()
}
