//! When a move has arrived.

/// A move has arrived when the angle stays within this distance of the set point, degree.
pub const ARRIVED_DEG: f64 = 0.5;
