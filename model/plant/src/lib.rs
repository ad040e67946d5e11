//! The plant of an electro-hydraulic three-point hitch, in SI units.
//!
//! ```text
//!                 relief                       load
//!                   |                           |
//!   pump ---+---- PC valve -> tank           linkage
//!           |                                   |
//!           +-- lift valve -- check valve --+-- cylinder
//!                                           |
//!                                  lowering valve -> return line -> tank
//! ```
//!
//! From the bottom layer to the top: [`units`] and [`Channel`]; [`components`], one per file; their [`Constants`] and
//! the [state](MechanicalState) of a run; [`hooks`], at which physical effects act; [`Model`]; the [`solver`] for the
//! hydraulics at one instant and the motion of the piston; [`Plant`]; and the [`simulation`] of whole runs.
//!
//! One meets a [`Model`] with its [`Constants`], a [`Rig`], the currents that drive it, and the [`Trace`](simulation::Trace)
//! of a run.
//!
//! Depends on no other crate of the project.
#![forbid(unsafe_code)]

pub mod channel;
pub mod components;
mod constants;
pub mod hooks;
mod model;
mod plant;
pub mod simulation;
pub mod solver;
mod state;
pub mod units;
mod valve;

pub use channel::Channel;
pub use components::check_valve::CheckValve;
pub use components::compensator::Compensator;
pub use components::cylinder::Cylinder;
pub use components::linkage::{Joints, Linkage, LinkageDimensions, Posture};
pub use components::linkage_error::LinkageError;
pub use components::linkage_table::{LinkageTable, LinkageTableError};
pub use components::load::Masses;
pub use components::oil::Oil;
pub use components::orifice_valve::OrificeValve;
pub use components::pump::{Pump, PumpKind};
pub use components::relief_valve::ReliefValve;
pub use components::sensor_noise::SensorNoise;
pub use components::solenoid::Solenoid;
pub use components::usual_loads::UsualLoads;
pub use components::valve_curve::{ValveCurve, ValveCurveError};
pub use constants::{Constants, Dynamics};
pub use hooks::effect::{
    AddedEffect, Effect, Parameter, ParameterKind, SizeResponse, full_name, is_same,
};
pub use hooks::place::Place;
pub use hooks::reading::Reading;
pub use model::Model;
pub use plant::Plant;
pub use state::{HitchRig, MechanicalState, Rig};
pub use valve::{Currents, Valve};
