//! Selection of the function that determines the set point, each change of it without a step.
//!
//! ```text
//!           in the soil, sensors plausible            function switched off, or sensor lost
//! +-------+ ---------------------------> +----------+ -----------------------------------> +-------+
//! | Lever |                              | Function |                                      | Holds |
//! +-------+ <--------------------------- +----------+                                      +-------+
//!   ^         above the ground              ^                                                 | |
//!   |                                       +-------------------------------------------------+ |
//!   |                                          switched off before, and selected again          |
//!   +-------------------------------------------------------------------------------------------+
//!                                           lever takes over
//! ```
//!
//! The loop of a function begins at the present set point, and begins there anew when another function is selected. That of the
//! depth takes over from the lever once the hitch has rested.
//!
//! Quick engagement begins in any of them. It lowers the set point until draft or depth are there, ahead of the implement's lag, and
//! hands over to the function; with its release it hands over to that function in the soil, and otherwise to the
//! lever.

use hitch_quantities::Function;
use hitch_quantities::calibration::design_parameters::LockParameters;
use hitch_quantities::units::MilliDegree;

use super::function_loop::{Errors, FunctionLoop};
use super::hold::Hold;
use super::lag_loop::Gains;
use super::low_pass::LowPass;
use crate::operator::engage::Engagement;

/// How far a held set point may be from the hitch: within it, a hitch at rest is not moved by the end of a function.
const NEAR: MilliDegree = MilliDegree(1_000);

/// What determines the set point.
#[derive(Clone, Copy, Debug, Default)]
pub enum Active {
    /// The lever.
    #[default]
    Lever,
    /// A function of draft or depth.
    Function(Function, FunctionLoop),
    /// The depth at the end of a function.
    Holds(Hold),
    /// Quick engagement, with a low-pass on draft or depth.
    Engages(LowPass),
}

/// What a selection is made from.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// Selected function; [`Function::Position`] as well if it lacks a set point.
    pub function: Function,
    /// The operator has selected position control.
    pub is_off: bool,
    /// Errors of draft or depth, while the sensors of the function are plausible.
    pub errors: Option<Errors>,
    /// Draft or depth will have reached the set point once the implement has followed the links.
    pub is_reached: bool,
    /// Switch of quick engagement.
    pub engagement: Engagement,
    /// A sensor of the function is lost.
    pub lost: bool,
    /// The implement is in the soil, by the sensor of the function.
    pub in_soil: bool,
    /// The hitch has rested for as long as the function requires.
    pub has_rested: bool,
    /// Lever.
    pub lever: MilliDegree,
    /// Rocker angle.
    pub angle: MilliDegree,
    /// Set point of the last step.
    pub present: MilliDegree,
    /// The same in steps: where position control moves the hitch.
    pub aim: MilliDegree,
}

impl Active {
    /// One step.
    #[must_use]
    pub fn next(self, choice: &Choice, gains: Gains, lock: &LockParameters) -> Self {
        let is_function = choice.function != Function::Position;
        if choice.engagement == Engagement::Begins {
            return Self::Engages(LowPass::default());
        }
        match self {
            Self::Engages(_) => choice.engaged(self, is_function, gains),
            Self::Lever => match choice.errors {
                Some(errors) if is_function && choice.in_soil && choice.has_rested => {
                    choice.begun(errors, gains)
                }
                _ => self,
            },
            Self::Function(..) if !is_function || choice.lost => {
                choice.held(choice.is_off && !choice.lost)
            }
            Self::Function(..) if !choice.in_soil => Self::Lever,
            Self::Function(function, _) => match choice.errors {
                Some(errors) if function != choice.function => choice.begun(errors, gains),
                _ => self,
            },
            Self::Holds(mut hold) => {
                let is_over = hold.is_over(choice.lever, lock);
                match choice.errors {
                    _ if is_over => Self::Lever,
                    Some(errors) if hold.resumes() && is_function && choice.in_soil => {
                        choice.begun(errors, gains)
                    }
                    _ => Self::Holds(hold),
                }
            }
        }
    }
}

impl Choice {
    /// One step of quick engagement.
    fn engaged(&self, present: Active, is_function: bool, gains: Gains) -> Active {
        let is_held = self.engagement == Engagement::Held;
        match self.errors {
            _ if is_function && self.lost => self.held(false),
            Some(errors) if is_function && self.takes_over(is_held) => self.begun(errors, gains),
            _ if is_held => present,
            _ => Active::Lever,
        }
    }

    /// Whether the function takes over.
    const fn takes_over(&self, is_held: bool) -> bool {
        if is_held {
            self.in_soil && self.is_reached
        } else {
            self.in_soil
        }
    }

    /// The selected function, from the present set point on.
    fn begun(&self, errors: Errors, gains: Gains) -> Active {
        Active::Function(
            self.function,
            FunctionLoop::from(self.present, errors, gains),
        )
    }

    /// The present depth, from now on; `resumes`: until a function is selected, too.
    #[must_use]
    pub fn held(&self, resumes: bool) -> Active {
        Active::Holds(Hold::new(self.here(), self.lever, resumes))
    }

    /// The present depth: where position control moves the hitch, if that is near.
    #[must_use]
    pub fn here(&self) -> MilliDegree {
        self.aim.limited(self.angle - NEAR, self.angle + NEAR)
    }
}
