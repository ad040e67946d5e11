//! Whether the operator wants anything to move.

use hitch_quantities::Inputs;
use hitch_quantities::calibration::design_parameters::SafetyParameters;
use hitch_quantities::units::MilliDegree;

/// Whether the operator has touched anything since power-up or the last trip.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arming {
    armed: bool,
    /// Where the lever was first seen.
    lever: Option<MilliDegree>,
    released: bool,
}

impl Arming {
    /// One step; true once the operator has touched lever or button.
    pub fn update(
        &mut self,
        inputs: &Inputs,
        tripped: bool,
        parameters: &SafetyParameters,
    ) -> bool {
        if tripped {
            *self = Self::default();
            return false;
        }
        self.lever = self.lever.or(inputs.lever);
        let moved = self
            .lever
            .zip(inputs.lever)
            .is_some_and(|(first, now)| (now - first).magnitude() >= parameters.arming_movement);
        let pressed = self.released && inputs.jog.is_some();
        self.released |= inputs.jog.is_none();
        self.armed |= moved || pressed;
        self.armed
    }
}
