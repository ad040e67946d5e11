//! The closed loop of the page: the firmware's controller with the present model, advanced in steps that the page
//! requests.
//!
//! Two hitches receive the same orders. Their plant is the present model; the calibration of the first is built from
//! the initial model, that of the second from the present one. Both run in a thread of their own, `bench::Bench`.
//!
//! With `--ecu`, the ECU runs in real time instead, with the calibration of the present model: `emulated::EcuSocket`.
//! With `--can`, the page shows an ECU on the bus: `bus::BusMonitor`.
mod bench;
mod bus;
mod description;
mod ecu_bench;
mod emulated;
mod figures;
mod hitch;
mod loop_source;
mod machine;
mod orders;
mod routes;
mod sensor_fault;
mod strip;
mod words;

pub use loop_source::{LoopSource, TabLoop};
pub use machine::Models;
pub use routes::routes;
