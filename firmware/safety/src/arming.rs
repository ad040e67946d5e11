//! Whether the operator wants anything to move.
//!
//! Lever and button arm separately. The lever arms until a lock closes. The button arms until the motion that it asked
//! for has ended, so that the lever has to be moved anew afterwards.
//!
//! | lock | lever | button |
//! |---|---|---|
//! | [`Lock::All`] | disarmed | disarmed, has to be seen released |
//! | [`Lock::Lever`] | disarmed | arms |
//! | [`Lock::Open`] | arms | arms |

use hitch_quantities::Inputs;
use hitch_quantities::calibration::design_parameters::SafetyParameters;
use hitch_quantities::units::MilliDegree;

use crate::locks::Lock;

/// What the operator has touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Touch {
    /// The lever was moved.
    Lever,
    /// The button was pressed.
    Button,
}

/// Whether the operator has touched anything since power-up, the last trip or the last lock.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arming {
    touched: Option<Touch>,
    /// Where the lever was first seen since it was disarmed.
    lever: Option<MilliDegree>,
    /// The button has been seen released.
    released: bool,
}

impl Arming {
    /// One step; true if lever or button arms. `at_rest`: no current was passed in the last step.
    pub fn update(
        &mut self,
        inputs: &Inputs,
        lock: Lock,
        at_rest: bool,
        parameters: &SafetyParameters,
    ) -> bool {
        if lock == Lock::All {
            *self = Self::default();
            return false;
        }
        let pressed = inputs.jog.is_some();
        if self.is_by_button() && !pressed && at_rest {
            self.touched = None;
        }
        if lock == Lock::Lever && self.touched == Some(Touch::Lever) {
            self.touched = None;
        }
        if lock == Lock::Lever || self.is_by_button() {
            self.lever = None;
        } else if self.is_moved(inputs, parameters) {
            self.touched = Some(Touch::Lever);
        }
        if pressed && self.released {
            self.touched = Some(Touch::Button);
        }
        self.released |= !pressed;
        self.touched.is_some()
    }

    /// True if the button has armed.
    pub fn is_by_button(&self) -> bool {
        self.touched == Some(Touch::Button)
    }

    /// True if the lever is away from where it was first seen.
    fn is_moved(&mut self, inputs: &Inputs, parameters: &SafetyParameters) -> bool {
        self.lever = self.lever.or(inputs.lever);
        self.lever
            .zip(inputs.lever)
            .is_some_and(|(first, now)| (now - first).magnitude() >= parameters.arming_movement)
    }
}
