//! What a campaign gives: prepared runs, cleaned currents, noise, regimes, clocks.

pub mod clocks;
pub mod condense;
pub mod conditioning;
pub mod defect_correction;
pub mod experiment;
pub mod noise;
pub mod regime;
pub mod start_angle;
pub mod trace_cache;
