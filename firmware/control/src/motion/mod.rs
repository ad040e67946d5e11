//! Laws of motion: from a set point, or from a button, to the speed that is demanded.

pub mod position;
pub mod rate;
