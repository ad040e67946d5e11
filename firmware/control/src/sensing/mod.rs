//! Sensor signals and their plausibility.

pub mod sensors;
