//! One file a command: its arguments, and what it does.
pub mod compare;
pub mod effects;
pub mod paper;
pub mod simulate;
