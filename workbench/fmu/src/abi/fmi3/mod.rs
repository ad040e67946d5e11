//! The functions of FMI 3.0. A unit is for co-simulation without events; what it does not support is refused.

pub mod lifecycle;
pub mod state;
pub mod stepping;
pub mod types;
pub mod unsupported;
pub mod values;
