//! What several commands take from the command line, and the command that continues the work.

pub mod baseline;
pub mod demonstration;
pub mod effect;
mod interruption;
pub mod known_constants;
pub mod model;
pub mod next_command;
pub mod number;
pub mod search;
pub mod tolerances;
