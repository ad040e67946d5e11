//! The watch of the angle on drawn machines: what a frozen sensor costs, and that a healthy one trips nothing.
//!
//! ```text
//! freeze    one machine, one move, one instant at which the sensor freezes: the extra travel
//! healthy   machines that stick, creep, land and are corrected, whose sensors are good: the false trips
//! quantiles what many freezes cost
//! ```

pub mod freeze;
pub mod healthy;
pub mod quantiles;
