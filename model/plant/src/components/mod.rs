//! The components, one per file: constants and equations.

pub mod check_valve;
pub mod compensator;
pub mod cylinder;
pub mod lag;
pub mod linkage;
pub mod linkage_error;
pub mod linkage_sketch;
pub mod linkage_table;
pub mod load;
pub mod oil;
pub mod orifice_valve;
pub mod pump;
pub mod relief_valve;
pub mod sensor_noise;
pub mod solenoid;
pub mod usual_loads;
pub mod valve_curve;
