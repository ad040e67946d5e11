//! Detection of a frozen angle on drawn machines: extra travel with a frozen sensor, and false trips with a healthy
//! one.
//!
//! ```text
//! freeze    one machine, one move, one instant of the freeze: the extra travel healthy   machines with healthy sensors
//! that stick, creep, land and are corrected: the false trips quantiles quantiles of the extra travel
//! ```

pub mod freeze;
pub mod healthy;
pub mod quantiles;
