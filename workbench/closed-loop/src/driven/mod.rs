//! Two hitches that follow the orders of the user of a page.
//!
//! Their plant is the present model; the calibration of the first is built from the initial model, that of the second
//! from the present one.

mod description;
mod figures;
mod hitch;
mod machine;
mod orders;
mod pair;
mod sensor_fault;
mod strip;
mod words;

pub use description::Described;
pub use figures::MoveFigures;
pub use machine::{Machine, MachineError, Models, calibration};
pub use orders::{Button, LONGEST_MS, Orders, wrong_advance};
pub use pair::Pair;
pub use sensor_fault::{Kind, Sensor, SensorFault};
pub use strip::{HitchView, Strip};
