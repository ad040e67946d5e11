//! The two valves: their curves, the inverse of these, and how they close.

pub mod closing;
pub mod drop_scale;
pub mod inverse_curve;
pub mod phase;
pub mod valve_map;
