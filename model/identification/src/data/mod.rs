//! Preparation of a campaign: runs, conditioned currents, noise, regimes, clock offsets.

pub mod clocks;
pub(crate) mod condense;
pub mod conditioning;
pub(crate) mod defect_correction;
pub mod experiment;
pub mod limit;
pub mod noise;
pub mod nuisance;
pub mod problem;
pub mod ready_run;
pub mod regime;
pub(crate) mod start_angle;
pub(crate) mod stretches;
pub mod trace_cache;
