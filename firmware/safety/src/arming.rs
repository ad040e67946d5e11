//! Whether the operator wants anything to move.
//!
//! Lever and button arm separately. The lever arms until a lock closes. The button arms until the motion that it asked
//! for has ended, so that the lever has to be moved anew afterwards, and no further than its longest travel.
//!
//! | lock | lever | button |
//! |---|---|---|
//! | [`Lock::All`] | disarmed | disarmed, has to be seen released |
//! | [`Lock::Lever`] | disarmed | arms |
//! | [`Lock::Open`] | arms | arms |

use hitch_quantities::Inputs;
use hitch_quantities::units::MilliDegree;

use crate::button::{Button, Press};
use crate::limits::Limits;
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
    button: Button,
    /// Where the hitch was when the last press began.
    pressed_at: Option<MilliDegree>,
}

impl Arming {
    /// One step; true if lever or button arms. `at_rest`: no current was passed in the last step.
    pub fn update(
        &mut self,
        inputs: &Inputs,
        lock: Lock,
        at_rest: bool,
        limits: Limits<'_>,
    ) -> bool {
        let press = self
            .button
            .judge(inputs, limits.operator.second_contact.0 != 0);
        if lock == Lock::All {
            *self = Self::default();
            return false;
        }
        if self.is_by_button() && press == Press::None && at_rest {
            self.touched = None;
        }
        if lock == Lock::Lever && self.touched == Some(Touch::Lever) {
            self.touched = None;
        }
        if lock == Lock::Lever || self.is_by_button() {
            self.lever = None;
        } else if self.is_moved(inputs, limits) {
            self.touched = Some(Touch::Lever);
        }
        if press != Press::None {
            self.touched = Some(Touch::Button);
        }
        self.bound_travel(press, inputs, limits);
        self.touched.is_some()
    }

    /// True if the button has armed.
    pub fn is_by_button(&self) -> bool {
        self.touched == Some(Touch::Button)
    }

    /// Disarms a button whose press has moved the hitch by its longest travel, its ramp after the release included.
    /// Teaching, with the service contact closed, moves to both ends.
    fn bound_travel(&mut self, press: Press, inputs: &Inputs, limits: Limits<'_>) {
        if press == Press::Begins {
            self.pressed_at = None;
        }
        self.pressed_at = self.pressed_at.or(inputs.rocker_angle);
        let travel = self
            .pressed_at
            .zip(inputs.rocker_angle)
            .map_or(MilliDegree(0), |(from, now)| (now - from).magnitude());
        let is_spent = travel >= limits.rate.longest_travel && !inputs.switches.teach;
        if self.is_by_button() && is_spent {
            self.touched = None;
            self.button.distrust();
        }
    }

    /// True if the lever is away from where it was first seen.
    fn is_moved(&mut self, inputs: &Inputs, limits: Limits<'_>) -> bool {
        self.lever = self.lever.or(inputs.lever);
        self.lever
            .zip(inputs.lever)
            .is_some_and(|(first, now)| (now - first).magnitude() >= limits.safety.arming_movement)
    }
}
