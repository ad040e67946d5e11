//! The firmware's controller in closed loop with a plant.
//!
//! A [`ClosedLoop`] is one hitch in steps of a millisecond. [`calibrate`] converts a model into the firmware's
//! calibration, with the static curves of [`valve_survey`]. A [`field::FieldRig`] has a tractor on a field behind the hitch. [`driven`] is the closed loop of a page: two hitches that
//! follow the orders of a user.
//!
//! The crate uses no thread, file, clock or network, so that it also runs inside a browser. The folders are layers, the
//! lowest first: `valve_survey`, `closed_loop`, `calibrate` and `field`, `driven`.
#![forbid(unsafe_code)]

pub mod calibrate;
mod closed_loop;
pub mod driven;
pub mod field;
pub mod valve_survey;

pub use closed_loop::{
    ARRIVED_DEG, ClosedLoop, Coil, DrivenPlant, Instruments, STEP_S, SUPPLY_V, Sample,
    with_dynamics,
};
