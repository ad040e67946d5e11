//! One file a command: its arguments, and what it does.
pub mod add;
pub mod compare;
pub mod diagnose;
pub mod effects;
pub mod explain;
pub mod main_job;
pub mod paper;
pub mod simulate;
