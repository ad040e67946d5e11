//! Control laws: from a set point or a button to the demanded speed.

pub mod bands;
pub mod position;
pub mod rate;
pub mod stop_band;
pub mod time_until_work;
