//! Imports a campaign from arbitrary logs: assigns their columns, and finds the runs in them.
//!
//! `hitch import` and the page of `hitch serve` use the same functions; only the dialogue is the command's.
pub mod columns;
pub mod cuts;
pub mod dialogue;
mod doubts;
pub mod files;
pub mod load;
pub mod manifest;
mod mapping;
pub mod note;
pub mod run_block;
#[cfg(test)]
mod tests;
pub mod times;
pub mod words;

pub use columns::Kind;
pub use files::{Columns, Files};
pub use load::loads_in_name;
pub use mapping::{Mapping, Taken, Undetermined};
pub use note::Note;
