//! The functions of FMI 2.0 for co-simulation.

pub mod lifecycle;
pub mod state;
pub mod stepping;
pub mod types;
pub mod values;
