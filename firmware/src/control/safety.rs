//! The safety envelope: last before the coils, and knows nothing of the controller.
//!
//! It takes requested currents and the measured angle, and lets through what can't hurt: currents
//! inside the coils' limits, rising no faster than their slope, never both coils, only on a fresh command, and
//! only while the hitch doesn't move against the energised coil. Otherwise both coils are off. After
//! a trip they stay off until [`Envelope::reset`].

use super::design_parameters::SafetyParameters;
use super::units::{MilliAmp, MilliDegree, Millisecond};

/// Currents of the two coils.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CoilCurrents {
    /// Lift coil.
    pub lift: MilliAmp,
    /// Lowering coil.
    pub lower: MilliAmp,
}

impl CoilCurrents {
    /// Both coils off.
    pub const OFF: Self = Self {
        lift: MilliAmp::ZERO,
        lower: MilliAmp::ZERO,
    };
}

/// The envelope.
#[derive(Clone, Copy, Debug, Default)]
pub struct Envelope {
    command: CoilCurrents,
    age: Millisecond,
    passed: CoilCurrents,
    /// Furthest angle along the energised coil's way since it was switched on.
    furthest: Option<MilliDegree>,
    tripped: bool,
}

impl Envelope {
    /// One step. `command`: a fresh request, if there is one; `angle`: the rocker angle, if it is known.
    pub fn pass(
        &mut self,
        command: Option<CoilCurrents>,
        angle: Option<MilliDegree>,
        parameters: &SafetyParameters,
    ) -> CoilCurrents {
        match command {
            Some(fresh) => {
                self.command = fresh;
                self.age = Millisecond::ZERO;
            }
            None => self.age = self.age.next(),
        }
        let contradictory = self.contradicts(self.command) || self.moves_against(angle, parameters);
        self.tripped = self.tripped || contradictory;
        let stale = self.age >= parameters.command_age;
        self.passed = if self.tripped || stale {
            CoilCurrents::OFF
        } else {
            self.bounded(parameters)
        };
        if self.passed == CoilCurrents::OFF {
            self.furthest = None;
        }
        self.passed
    }

    /// True after a trip.
    #[must_use]
    pub const fn is_tripped(&self) -> bool {
        self.tripped
    }

    /// Clears a trip; the coils start from zero.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    fn contradicts(&self, command: CoilCurrents) -> bool {
        command.lift > MilliAmp::ZERO && command.lower > MilliAmp::ZERO
    }

    /// True if the hitch has come back further than allowed while a coil was on.
    fn moves_against(&mut self, angle: Option<MilliDegree>, parameters: &SafetyParameters) -> bool {
        let Some(angle) = angle.filter(|_| self.passed != CoilCurrents::OFF) else {
            return false;
        };
        let lifting = self.passed.lift > MilliAmp::ZERO;
        let along = if lifting { angle } else { -angle };
        let furthest = self.furthest.map_or(along, |furthest| furthest.max(along));
        self.furthest = Some(furthest);
        furthest - along > parameters.contradiction
    }

    fn bounded(&self, parameters: &SafetyParameters) -> CoilCurrents {
        let changes_over = (self.passed.lift > MilliAmp::ZERO
            && self.command.lower > MilliAmp::ZERO)
            || (self.passed.lower > MilliAmp::ZERO && self.command.lift > MilliAmp::ZERO);
        if changes_over {
            // One step with both coils off, so that the angle watch starts anew.
            return CoilCurrents::OFF;
        }
        let bound = |command: MilliAmp, passed: MilliAmp, limit: MilliAmp| {
            let rising = passed.max(parameters.free_current) + MilliAmp(parameters.current_slope.0);
            command.max(MilliAmp::ZERO).min(limit).min(rising)
        };
        CoilCurrents {
            lift: bound(
                self.command.lift,
                self.passed.lift,
                parameters.lift_current_limit,
            ),
            lower: bound(
                self.command.lower,
                self.passed.lower,
                parameters.lower_current_limit,
            ),
        }
    }
}
