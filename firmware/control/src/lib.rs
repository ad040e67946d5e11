//! Control of the hitch: from lever and sensors to the requested currents, and the regulation of the currents that the
//! safety envelope allows. Pure, without clock, heap, I/O or floating point, and so bit-identical on the ECU and
//! on the host.
//!
//! It may depend on `hitch-quantities` alone: it does not depend on the safety envelope or the bus.
//!
//! ```text
//! Inputs -> sensors -> start-up lock, modes -> reference -> position | rate control -> desired piston speed
//!        -> check-valve and compensator logic -> inverse valve map -> currents that are asked for
//! ```
//!
//! Its folders from the bottom to the top; one may use those above it in this list (`cargo xtask check` holds them to
//! it):
//!
//! * [`valve`]: valve curves and their inverse, closing of the valves, demand and phase,
//! * [`sensing`]: validation of the sensors,
//! * [`operator`]: lever, button, dials and switches, the start-up lock, and the mode that follows from them,
//! * [`reference`](mod@reference): draft, mix, depth limit and slip guard: the set point that they make of the lever,
//! * [`ride`]: ride damping in transport: a piston speed from the pressure in the cylinder,
//! * [`estimation`]: observers of motion, load and valve dynamics,
//! * [`adaptation`]: adaptation of the valve model by the moves of this machine,
//! * [`motion`]: position and rate law, from a set point or a button to a demanded speed,
//! * [`sequencing`]: check-valve logic, stall detection, drift monitoring,
//! * [`current`]: the regulation of a coil's current,
//! * [`commissioning`]: teaching of a machine,
//! * [`controller`]: the step of one millisecond and its feedback law: [`Control`].
//!
//! Quantities are integers with their unit in the type; their arithmetic saturates. The calibration has been validated
//! before.
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
pub mod reference;
pub mod ride;
pub mod sensing;
pub mod sequencing;
pub mod valve;

pub use controller::{Control, ControlRequest};
