//! What the envelope goes by.

use hitch_quantities::calibration::design_parameters::{
    LockParameters, OperatorParameters, RateParameters, RemoteParameters, SafetyParameters,
    SensorParameters,
};
use hitch_quantities::calibration::field_parameters::RideParameters;

use super::machine_model::MachineModel;

/// What the envelope goes by.
#[derive(Clone, Copy, Debug)]
pub struct Limits<'a> {
    /// Its own limits.
    pub safety: &'a SafetyParameters,
    /// What sensors can plausibly say.
    pub sensors: &'a SensorParameters,
    /// When the engine locks the hitch, and how long no row may have held before a reset.
    pub lock: &'a LockParameters,
    /// Where the dials are shut, and the contacts of the buttons.
    pub operator: &'a OperatorParameters,
    /// How far a button moves the hitch.
    pub rate: &'a RateParameters,
    /// How the operator consents to remote control.
    pub remote: &'a RemoteParameters,
    /// What ride damping keeps to.
    pub ride: &'a RideParameters,
    /// They, or others of their calibration, have changed in memory.
    pub damaged: bool,
    /// What currents do to the hitch.
    pub machine: MachineModel<'a>,
}
