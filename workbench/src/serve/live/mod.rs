//! The closed loop of the page: the firmware's controller with the present model, advanced in steps that the page
//! requests.
//!
//! Two hitches receive the same orders. Their plant is the present model; the calibration of the first is built from
//! the initial model, that of the second from the present one. Both run in a thread of their own, `bench::Bench`.
mod bench;
mod description;
mod figures;
mod hitch;
mod machine;
mod orders;
mod routes;
mod sensor_fault;
mod words;

pub use bench::Bench;
pub use routes::routes;
