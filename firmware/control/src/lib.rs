//! The control of the hitch: from lever and sensors to the currents that it asks for, and the regulation of those that
//! the safety envelope lets pass. Pure, without clock, heap, I/O or floating point, and so bit-identical on the ECU and
//! on the host.
//!
//! It may depend on `hitch-quantities` alone: it knows nothing of the envelope that judges it, nor of the bus.
//!
//! ```text
//! Inputs -> sensors -> start-up lock, modes -> position | rate control -> desired piston speed
//!        -> check-valve and compensator logic -> inverse valve map -> currents that are asked for
//! ```
//!
//! Its folders from the bottom to the top; one may use those above it in this list (`cargo xtask check` holds them to it):
//!
//! * [`valve`]: the valves' curves and their inverse, how they close, and what they are asked for,
//! * [`sensing`]: what the sensors say, judged,
//! * [`operator`]: lever, button, dials and switches, the start-up lock, and the mode that follows from them,
//! * [`estimation`]: where the hitch is, how fast it goes, what it carries,
//! * [`adaptation`]: what moves teach about this machine,
//! * [`motion`]: laws of motion, from a set point or a button to a demanded speed,
//! * [`sequencing`]: the check valve's conditions, the compensator's, and a hitch that leaves its place,
//! * [`current`]: the regulation of a coil's current,
//! * [`commissioning`]: how a machine is taught,
//! * [`controller`]: all of it, a step a millisecond: [`Control`].
//!
//! Quantities are integers with their unit in the type; their arithmetic saturates. The calibration has been validated, so
//! that nothing here has to doubt it again.
//!
//! ```
//! use hitch_control::valve::valve_map::ValveCurves;
//! use hitch_quantities::ValidCalibration;
//! use hitch_quantities::units::{MicroLitrePerSecond, MilliBar};
//!
//! let calibration = ValidCalibration::nominal();
//! let curves = ValveCurves::of(&calibration);
//! let map = curves.at(curves.scale(MilliBar(60_000)));
//! // The inverse map and the curve agree.
//! let current = map.lift_current(MicroLitrePerSecond(400_000));
//! assert!((calibration.lift.flow(current).0 - 400_000).abs() < 1_000);
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

pub mod adaptation;
pub mod commissioning;
pub mod controller;
pub mod current;
pub mod estimation;
pub mod motion;
pub mod operator;
pub mod sensing;
pub mod sequencing;
pub mod valve;

pub use controller::{Control, Request};
