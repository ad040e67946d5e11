//! The paper's tables and figures, and their reproduction with this model.
//!
//! Source: "Unified modelling and simulation of electro-hydraulic proportional control valve using parameter
//! estimation technique" (Control Engineering Practice, manuscript D-20-00850).
pub mod check_valve;

pub mod flow_table;
pub mod orifice_area;
pub mod tables;
pub mod test_bench;
pub mod travel_time;
