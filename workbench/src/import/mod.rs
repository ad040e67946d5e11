//! Imports a campaign from arbitrary logs: assigns their columns, and finds the runs in them.
//!
//! `hitch import` and the page of `hitch serve` use the same functions; only the dialogue is the command's.
pub mod columns;
pub mod conditions;
pub mod cuts;
pub mod dialogue;
mod doubts;
pub mod files;
pub mod manifest;
#[cfg(test)]
mod tests;
pub mod times;
pub mod words;

pub use columns::{Kind, Mapping, Taken, Untold};
pub use conditions::{Conditions, load_in_name};
pub use files::{Columns, Files};
