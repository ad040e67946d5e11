//! Teaching: a machine finds its own thresholds, ends, lags and hysteresis.

pub mod teach;
pub mod teach_hysteresis;
pub mod teach_lag;
pub mod teach_twin;
