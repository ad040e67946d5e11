//! The safety envelope: first and last act of a step on the way to the coils. It knows nothing of the controller.
//!
//! It may depend on `hitch-quantities` alone. Nothing of control is in its reach, nor is it in the reach of control:
//! `hitch-controller` hands the one's command to the other.
//!
//! It gets requested currents and the raw inputs, and limits the currents that are regulated ([`Envelope::pass`]):
//! inside the coils' limits, rising no faster than their slope, never both coils, only on a command of this step, only
//! after the operator has touched lever or button, and only while no row of its table ([`rows`]) holds. Otherwise both
//! coils are off. The regulation then makes pulse widths of these currents. They pass through the envelope as well
//! ([`Envelope::release`]), which sets those of a coil without a current to zero. Nothing comes between that and the
//! drivers.
//!
//! ```text
//!  power-up   +----------+  lever moved, or button seen released and pressed   +-------+
//! ----------> | Disarmed | --------------------------------------------------> | Armed |
//!             |          | <-------------------------------------------------- |       |
//!             +----------+  transport lock, hold, engine stopped               +-------+
//!                  ^                                                               | a row holds for its time
//!                  |  reset, once no row has held for `lock.healthy_time`          v
//!                  +---------------------------------------------------------- +---------+
//!                                         (never, for a final row)             | Tripped |
//!                                                                              +---------+
//! ```
//!
//! Its parts are watches, each for some rows of the table: `angle` (with `following` and `noise_detector`), `coils`,
//! `supply`, `measuring`, `travel_limits`; `locks` for the operator's locks; `arming` for the operator's touch, with `button`; `consent` for remote
//! control; `ride` for ride damping; and [`rows`], which counts how long each row has been holding.
//!
//! ```
//! use hitch_quantities::{CoilCurrents, Inputs, ValidCalibration};
//! use hitch_safety::{Command, Envelope, Limits, MachineModel};
//!
//! let calibration = ValidCalibration::nominal();
//! let limits = Limits {
//!     safety: &calibration.safety,
//!     sensors: &calibration.sensors,
//!     lock: &calibration.lock,
//!     operator: &calibration.operator,
//!     rate: &calibration.rate,
//!     remote: &calibration.remote,
//!     ride: &calibration.ride,
//!     damaged: false,
//!     machine: MachineModel::of(&calibration),
//! };
//! let mut envelope = Envelope::default();
//! let mut currents = CoilCurrents::OFF;
//! currents.lift.0 = 2_000;
//! // The operator has touched nothing yet, and no sensor says anything.
//! let command = Command { currents, step: envelope.step() };
//! assert_eq!(envelope.pass(command, &Inputs::default(), limits), CoilCurrents::OFF);
//! ```
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod angle;
mod arming;
mod button;
mod coils;
mod command;
mod consent;
mod following;
mod limits;
mod locks;
mod measuring;
mod noise_detector;
mod ride;
pub mod rows;
mod samples;
mod supply;
mod travel_limits;

use hitch_quantities::calibration::design_parameters::LockParameters;
use hitch_quantities::units::{Duty, MilliAmp, Millisecond};
use hitch_quantities::{CoilCurrents, Duties, Inputs, Trip};

use angle::AngleWatch;
use arming::Arming;
use coils::CoilWatch;
pub use command::{Command, Step};
use consent::Consent;
pub use limits::{Limits, MachineModel};
use locks::{Lock, Locks};
use measuring::MeasuringFaults;
use ride::RideWatch;
use rows::{Debounce, Rows};
use supply::SupplyWatch;

/// Rows that hold while the controller bridges a sample of a sensor that it needs.
const BRIDGED: [Trip; 3] = [Trip::Lever, Trip::AngleMissing, Trip::AngleJumps];

/// The envelope.
#[derive(Clone, Copy, Debug, Default)]
pub struct Envelope {
    locks: Locks,
    arming: Arming,
    consent: Consent,
    ride: RideWatch,
    /// The next command is one of ride damping.
    rides: bool,
    angle: AngleWatch,
    coils: CoilWatch,
    supply: SupplyWatch,
    debounce: Debounce,
    /// Number of the last step.
    step: Step,
    passed: CoilCurrents,
    /// Currents whose pulse widths may be released in this step.
    released: CoilCurrents,
    tripped: Option<Trip>,
    /// How long no row has held, at most `lock.healthy_time`.
    calm_for: Millisecond,
    /// No row has held for `lock.healthy_time`.
    healthy: bool,
    /// The command was more than a hitch gets that has yet to start.
    holds_back: bool,
}

impl Envelope {
    /// The step that the next [`Self::pass`] is: its command has to carry this.
    #[must_use]
    pub const fn step(&self) -> Step {
        self.step.next()
    }

    /// The next command is one of ride damping: it has to keep to the row for that, besides all others.
    pub fn claim_ride(&mut self) {
        self.rides = true;
    }

    /// One step, whether or not there is a command of it. `inputs`: what the sensors say, unjudged. The currents that
    /// may be regulated.
    pub fn pass(&mut self, command: Command, inputs: &Inputs, limits: Limits<'_>) -> CoilCurrents {
        self.step = self.step.next();
        let fresh = command.step == self.step;
        let command = Some(command.currents).filter(|_| fresh);
        let measuring = measuring::judge(inputs, limits.sensors, limits.safety);
        let slow_start = self.starts_slowly(inputs);
        let lock = self.locks.judge(inputs, limits.lock);
        let holds = self.rows_that_hold(command, inputs, measuring, slow_start, lock, limits);
        let found = self.debounce.judge(holds, measuring.lost, limits.safety);
        self.count_health(limits.lock);
        // The first trip is the one to report, unless a worse one comes.
        if self.tripped.is_none_or(|trip| !trip.is_final()) {
            self.tripped = found
                .filter(|trip| trip.is_final())
                .or(self.tripped)
                .or(found);
        }
        let at_rest = self.passed == CoilCurrents::OFF;
        let armed = match self.tripped {
            None => self.arming.update(inputs, lock, at_rest, limits),
            Some(_) => {
                self.disarm();
                false
            }
        };
        // While a sample is bridged a coil that is on stays on, but none is switched on.
        let bridged = holds.has_any(&BRIDGED) && at_rest;
        self.holds_back = false;
        self.passed = match command {
            Some(command) if armed && !bridged => {
                let command = self.angle.withhold(command);
                self.bounded(command, slow_start, limits)
            }
            _ => CoilCurrents::OFF,
        };
        self.released = self.passed;
        self.passed
    }

    /// The last act of a step: the pulse widths that the drivers may get. Zero for a coil that [`Self::pass`] has let
    /// no current pass to in this step; zero for both if it wasn't called since the last release.
    #[must_use]
    pub fn release(&mut self, duties: Duties) -> Duties {
        let released = core::mem::take(&mut self.released);
        let width = |current: MilliAmp, duty: Duty| {
            if current > MilliAmp::ZERO {
                duty.limited(Duty::ZERO, Duty::WHOLE)
            } else {
                Duty::ZERO
            }
        };
        Duties {
            lift: width(released.lift, duties.lift),
            lower: width(released.lower, duties.lower),
        }
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

    /// True while the lowering coil is cut, since the hitch stands still and may lie on the ground.
    #[must_use]
    pub const fn has_ground_contact(&self) -> bool {
        self.angle.has_ground_contact()
    }

    /// True if the command was more than a hitch gets that has yet to start: its ramp has to wait.
    #[must_use]
    pub const fn holds_back(&self) -> bool {
        self.holds_back
    }

    /// Asks for the end of a trip. It ends if it is not final and no row has held for `lock.healthy_time`; the watches
    /// go on.
    pub fn reset(&mut self) {
        if self.healthy && self.objection().is_none() {
            self.tripped = None;
        }
    }

    /// Lever or button have to be touched anew.
    pub fn disarm(&mut self) {
        self.arming = Arming::default();
    }

    /// Begins anew with another machine. A final trip stays, and so does what is known of the engine.
    pub fn restart(&mut self) {
        if !self.tripped.is_some_and(Trip::is_final) {
            *self = Self {
                locks: self.locks,
                ..Self::default()
            };
        }
    }

    fn count_health(&mut self, parameters: &LockParameters) {
        let calm_for = self.calm_for.counted_while(self.debounce.is_calm());
        self.calm_for = calm_for.min(parameters.healthy_time);
        self.healthy = self.calm_for >= parameters.healthy_time;
    }

    /// True while the operator teaches: the service contact is closed, and the button is pressed that armed. Currents
    /// then rise slowly from below any threshold, and the thresholds need not be those of the calibration: nothing is
    /// required, and nothing is held back, before motion is seen. Teaching moves to both ends, beyond the limits.
    fn starts_slowly(&self, inputs: &Inputs) -> bool {
        inputs.switches.teach && inputs.jog.is_some() && self.arming.is_by_button()
    }

    /// Whether each row of the table holds in this step, in its order.
    fn rows_that_hold(
        &mut self,
        command: Option<CoilCurrents>,
        inputs: &Inputs,
        measuring: MeasuringFaults,
        slow_start: bool,
        lock: Lock,
        limits: Limits<'_>,
    ) -> Rows {
        let (safety, sensors) = (limits.safety, limits.sensors);
        let angle = self.angle.judge(inputs, self.passed, slow_start, limits);
        let coils = self.coils.judge(self.passed, inputs, safety);
        let outside = |value: i32, low: i32, high: i32| value < low || value > high;
        let lever_bad = inputs
            .lever
            .is_none_or(|lever| outside(lever.0, sensors.lever_min.0, sensors.lever_max.0));
        let supply_bad = self.supply.judge(inputs, safety);
        let both =
            command.is_some_and(|both| both.lift > MilliAmp::ZERO && both.lower > MilliAmp::ZERO);
        let beyond_limit = !slow_start && travel_limits::are_exceeded(inputs, self.passed, limits);
        let no_consent = self.consent.is_missing(inputs, lock, limits.remote)
            && self.passed != CoilCurrents::OFF;
        let claims = core::mem::take(&mut self.rides);
        let ride = self
            .ride
            .judge(inputs, self.passed, claims, lock, (limits.ride, safety));
        Rows::of([
            (Trip::Stale, command.is_none()),
            (Trip::BothCoils, both),
            (Trip::Overrun, measuring.lost != Millisecond::ZERO),
            (Trip::Supply, supply_bad),
            (Trip::Lever, lever_bad),
            (Trip::AngleMissing, angle.missing),
            (Trip::AngleJumps, angle.jumps),
            (Trip::AngleFrozen, angle.frozen),
            (Trip::AngleNoisy, angle.noisy),
            (Trip::NotFollowing, angle.not_following),
            (Trip::Against, angle.against),
            (Trip::CoilOpen, coils.open),
            (Trip::CoilShort, coils.short),
            (Trip::CoilStuck, coils.stuck),
            (Trip::Reference, measuring.reference),
            (Trip::SensorSupply, measuring.sensor_supply),
            (Trip::AngleTracks, measuring.tracks),
            (Trip::Clock, measuring.clock),
            (Trip::EnableLine, inputs.enable_line_fault),
            (Trip::Memory, limits.damaged),
            (Trip::BeyondLimit, beyond_limit),
            (Trip::NoConsent, no_consent),
            (Trip::Ride, ride),
        ])
    }

    fn bounded(
        &mut self,
        command: CoilCurrents,
        slow_start: bool,
        limits: Limits<'_>,
    ) -> CoilCurrents {
        let parameters = limits.safety;
        let changes_over = (self.passed.lift > MilliAmp::ZERO && command.lower > MilliAmp::ZERO)
            || (self.passed.lower > MilliAmp::ZERO && command.lift > MilliAmp::ZERO);
        if changes_over {
            // A step with both coils off, so that the angle watch starts anew.
            return CoilCurrents::OFF;
        }
        let onset_limit = self
            .angle
            .onset_limit(slow_start, limits)
            .unwrap_or(CoilCurrents {
                lift: parameters.lift_current_limit,
                lower: parameters.lower_current_limit,
            });
        self.holds_back = command.lift > onset_limit.lift || command.lower > onset_limit.lower;
        let bound = |command: MilliAmp, passed: MilliAmp, limit: MilliAmp| {
            let rising = passed.max(parameters.free_current) + MilliAmp(parameters.current_slope.0);
            command.max(MilliAmp::ZERO).min(limit).min(rising)
        };
        CoilCurrents {
            lift: bound(
                command.lift,
                self.passed.lift,
                parameters.lift_current_limit.min(onset_limit.lift),
            ),
            lower: bound(
                command.lower,
                self.passed.lower,
                parameters.lower_current_limit.min(onset_limit.lower),
            ),
        }
    }
}
