//! Sequencing of the valves: check-valve logic, stall detection, drift monitoring.

pub mod drift_monitor;
pub mod stall_detector;
pub mod valve_logic;
