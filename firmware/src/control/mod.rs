//! The controller: from lever and sensors to two coil currents, one [`Controller::step`] a millisecond.
//!
//! ```text
//! Inputs -> sensors -> start-up lock, modes -> position | rate control -> desired piston speed
//!        -> check-valve and compensator logic -> inverse valve map -> safety envelope -> current regulation -> Outputs
//! ```
//!
//! Quantities are integers with their unit in the type ([`units`]); their arithmetic saturates.
//! What a machine can be taught is in a [`Calibration`]; the controller only takes one that has been
//! validated, so that nothing here has to doubt it again.

pub mod calibration;
pub mod calibration_words;
pub mod charge;
pub mod closing;
pub mod controller;
pub mod course;
pub mod current;
pub mod damping;
pub mod design_parameters;
pub mod drop_scale;
pub mod fixed;
pub mod free_fall;
pub mod inverse_curve;
pub mod lag;
pub mod late;
pub mod learning;
pub mod lever;
pub mod linkage;
pub mod load;
pub mod lock;
pub mod memory_check;
pub mod mode;
pub mod motion;
pub mod nominal;
pub mod offset;
pub mod operator;
pub mod outrun;
pub mod parameter;
pub mod pi;
pub mod position;
pub mod rate;
pub mod rest;
pub mod safety;
pub mod saturation;
pub mod sensors;
pub mod signals;
pub mod sink;
pub mod swing;
pub mod teach;
pub mod teach_hysteresis;
pub mod teach_lag;
pub mod teach_twin;
pub mod units;
pub mod valve_logic;
pub mod valve_map;

pub use calibration::{Calibration, CalibrationError, ValidCalibration};
pub use controller::Controller;
pub use mode::Fault;
pub use signals::{Inputs, Outputs, State, Switches};
