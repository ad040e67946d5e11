//! Imports a campaign from arbitrary logs: assigns their columns, and finds the runs in them.
pub mod columns;
pub mod cuts;
pub mod dialogue;
pub mod manifest;
pub mod words;

pub use columns::{Kind, Mapping, Taken, Untold};
