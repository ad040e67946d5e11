//! The closed loop of the page: the firmware's controller with the present model, advanced in steps that the page
//! requests.
//!
//! Two hitches receive the same orders, `hitch_closed_loop::driven`. Both run in a thread of their own, `bench::Bench`.
//!
//! With `--ecu`, the ECU runs in real time instead, with the calibration of the present model: `emulated::EcuSocket`.
//! With `--can`, the page shows an ECU on the bus: `bus::BusMonitor`.
pub(super) mod answer;
mod bench;
mod bus;
mod ecu_bench;
mod emulated;
mod loop_source;
mod routes;

pub use loop_source::{LoopSource, TabLoop};
pub use routes::routes;
