//! A campaign from anybody's logs: which of their columns is which, and where the runs are in them.
pub mod columns;
pub mod cuts;
pub mod dialogue;
pub mod manifest;
pub mod words;

pub use columns::{Kind, Mapping, Taken, Untold};
