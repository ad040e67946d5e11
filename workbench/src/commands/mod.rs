//! The commands, one module each: arguments and execution.
pub mod add;
pub mod adopt;
pub mod calibrate;
pub mod changes;
pub mod compare;
pub mod completions;
pub mod controller;
pub mod diagnose;
pub mod draft;
#[cfg(feature = "ecu")]
pub mod ecu;
pub mod effects;
pub mod explain;
#[cfg(feature = "fmu")]
pub mod export_fmu;
#[cfg(feature = "ecu")]
pub mod flash_calibration;
pub mod fleet;
pub mod import;
pub mod loop_;
pub mod loop_scenario;
pub mod main_job;
pub mod man;
pub mod model;
mod next_folder;
#[cfg(feature = "ecu")]
pub mod record;
pub mod schema;
#[cfg(feature = "page")]
pub mod serve;
pub mod simulate;
pub mod summary;
pub mod tune;
mod tune_field;
pub mod tune_result;
pub mod tune_scenario;
