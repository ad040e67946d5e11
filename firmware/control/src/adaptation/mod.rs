//! Adaptation to this machine by its moves; lost with the supply.

pub mod threshold_offset;
pub mod valve_adaptation;
