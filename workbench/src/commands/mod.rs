//! One file a command: its arguments, and what it does.
pub mod add;
pub mod calibrate;
pub mod changes;
pub mod compare;
pub mod controller;
pub mod diagnose;
pub mod ecu;
pub mod effects;
pub mod explain;
pub mod flash_calibration;
pub mod import;
pub mod loop_;
pub mod main_job;
pub mod paper;
pub mod record;
pub mod simulate;
pub mod tune;
