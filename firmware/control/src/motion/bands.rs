//! Bands that decide whether a resting hitch moves.
//!
//! They are taken over from the calibration with the set point: a tool that changes them does not start a motion.

use hitch_quantities::calibration::design_parameters::PositionParameters;
use hitch_quantities::units::{Micrometre, MilliDegree};

/// The bands of a set point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bands {
    /// What the lever has to exceed for a new set point.
    pub lever_deadband: MilliDegree,
    /// What a resting hitch has to exceed for a correction, of piston travel.
    pub restart_band: Micrometre,
}

impl Bands {
    /// Those of a calibration.
    #[must_use]
    pub const fn of(parameters: &PositionParameters) -> Self {
        Self {
            lever_deadband: parameters.lever_deadband,
            restart_band: parameters.restart_band,
        }
    }
}
