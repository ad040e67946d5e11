//! The safety envelope: last before the coils, and knows nothing of the controller.
//!
//! It takes requested currents and the raw inputs, and lets through what can't hurt: currents inside
//! the coils' limits, rising no faster than their slope, never both coils, only on a fresh command, only after the
//! operator has touched lever or button, and only while no row of its table ([`rows`]) holds. Otherwise
//! both coils are off.
//!
//! ```text
//!  power-up   +----------+  lever moved, or button seen released and pressed   +-------+
//! ----------> | Disarmed | --------------------------------------------------> | Armed |
//!             +----------+                                                     +-------+
//!                  ^                                                               | a row holds for its time
//!                  |  reset, once the row no longer holds                          v
//!                  +---------------------------------------------------------- +---------+
//!                                         (never, for a short or stuck coil)   | Tripped |
//!                                                                              +---------+
//! ```

mod angle;
mod coils;
pub mod rows;

use super::design_parameters::{SafetyParameters, SensorParameters};
use super::signals::Inputs;
use super::units::{MilliAmp, MilliDegree};
use angle::AngleWatch;
use coils::CoilWatch;
pub use rows::Trip;
use rows::{Debounce, Rows};

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

/// What the envelope goes by.
#[derive(Clone, Copy, Debug)]
pub struct Limits<'a> {
    /// Its own limits.
    pub safety: &'a SafetyParameters,
    /// What sensors can plausibly say.
    pub sensors: &'a SensorParameters,
}

/// The envelope.
#[derive(Clone, Copy, Debug, Default)]
pub struct Envelope {
    arming: Arming,
    angle: AngleWatch,
    coils: CoilWatch,
    debounce: Debounce,
    passed: CoilCurrents,
    tripped: Option<Trip>,
}

impl Envelope {
    /// One step. `command`: a fresh request, if there is one; `inputs`: what the sensors say, unjudged.
    pub fn pass(
        &mut self,
        command: Option<CoilCurrents>,
        inputs: &Inputs,
        limits: Limits<'_>,
    ) -> CoilCurrents {
        let holds = self.rows_that_hold(command, inputs, limits);
        let found = self.debounce.judge(holds, limits.safety);
        // The first trip is the one to report, unless a worse one comes.
        if self.tripped.is_none_or(|trip| !trip.is_final()) {
            self.tripped = found
                .filter(|trip| trip.is_final())
                .or(self.tripped)
                .or(found);
        }
        let armed = self
            .arming
            .update(inputs, self.tripped.is_some(), limits.safety);
        self.passed = match command {
            Some(command) if armed && self.tripped.is_none() => {
                self.bounded(command, limits.safety)
            }
            _ => CoilCurrents::OFF,
        };
        self.passed
    }

    /// What has tripped and still keeps it from being reset.
    #[must_use]
    pub fn objection(&self) -> Option<Trip> {
        self.tripped
            .filter(|trip| trip.is_final() || !self.debounce.is_calm())
    }

    /// What has tripped.
    #[must_use]
    pub const fn tripped(&self) -> Option<Trip> {
        self.tripped
    }

    /// Clears a trip, if it may be cleared; lever or button have to be touched anew. The watches go on.
    pub fn reset(&mut self) {
        if self.objection().is_none() {
            self.tripped = None;
            self.arming = Arming::default();
        }
    }

    /// Whether each row of the table holds in this step, in its order.
    fn rows_that_hold(
        &mut self,
        command: Option<CoilCurrents>,
        inputs: &Inputs,
        limits: Limits<'_>,
    ) -> Rows {
        let (safety, sensors) = (limits.safety, limits.sensors);
        let angle = self
            .angle
            .judge(inputs.rocker_angle, self.passed, sensors, safety);
        let coils = self.coils.judge(self.passed, inputs, safety);
        let outside = |value: i32, low: i32, high: i32| value < low || value > high;
        let lever_bad = inputs
            .lever
            .is_none_or(|lever| outside(lever.0, sensors.lever_min.0, sensors.lever_max.0));
        let supply_bad = inputs
            .supply
            .is_some_and(|supply| outside(supply.0, safety.supply_min.0, safety.supply_max.0));
        let both =
            command.is_some_and(|both| both.lift > MilliAmp::ZERO && both.lower > MilliAmp::ZERO);
        let late = inputs
            .step_time
            .is_some_and(|time| time > safety.longest_step);
        Rows::of([
            command.is_none(),
            both,
            late,
            supply_bad,
            lever_bad,
            angle.missing,
            angle.jumps,
            angle.frozen,
            angle.noisy,
            angle.not_following,
            angle.against,
            coils.open,
            coils.short,
            coils.stuck,
        ])
    }

    fn bounded(&self, command: CoilCurrents, parameters: &SafetyParameters) -> CoilCurrents {
        let changes_over = (self.passed.lift > MilliAmp::ZERO && command.lower > MilliAmp::ZERO)
            || (self.passed.lower > MilliAmp::ZERO && command.lift > MilliAmp::ZERO);
        if changes_over {
            // A step with both coils off, so that the angle watch starts anew.
            return CoilCurrents::OFF;
        }
        let bound = |command: MilliAmp, passed: MilliAmp, limit: MilliAmp| {
            let rising = passed.max(parameters.free_current) + MilliAmp(parameters.current_slope.0);
            command.max(MilliAmp::ZERO).min(limit).min(rising)
        };
        CoilCurrents {
            lift: bound(
                command.lift,
                self.passed.lift,
                parameters.lift_current_limit,
            ),
            lower: bound(
                command.lower,
                self.passed.lower,
                parameters.lower_current_limit,
            ),
        }
    }
}

/// Whether the operator has touched anything since power-up or the last trip.
#[derive(Clone, Copy, Debug, Default)]
struct Arming {
    armed: bool,
    /// Where the lever was first seen.
    lever: Option<MilliDegree>,
    released: bool,
}

impl Arming {
    fn update(&mut self, inputs: &Inputs, tripped: bool, parameters: &SafetyParameters) -> bool {
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
