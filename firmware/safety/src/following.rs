//! Following monitor: compares the travel that an energised coil must cause with the travel that the angle sensor
//! shows.
//!
//! An angle sensor that freezes during a move, or just as the coil is switched on, may still show noise, and a healthy
//! one may show none. But a coil that has carried a current for some time moves the hitch, whatever the controller has
//! requested since. This monitor computes the least travel of a healthy machine for the regulated currents (the
//! required travel) and compares it with the measured travel.
//!
//! A stroke has two parts. Before motion is detected, the start delay of the machine is unknown: it may be on the
//! ground, compress its oil, or have a slow spool. The travel that the valve curve predicts is limited in this part:
//!
//! ```text
//! predicted travel  sum of valve curve(current)
//! limit             (onset budget - predicted travel) / onset time, at least the onset speed
//! standstill        predicted travel, while the current is above threshold + margin, > onset debt
//! ```
//!
//! A hitch that is lifted off its lower end stop may lack the stop debt in addition: the stop carried the load, and the
//! oil has no pressure.
//!
//! After motion has been detected:
//!
//! ```text
//! expected         current less margin -> flow of the valve curve -> piston speed -> two lags
//! required speed   a share of that; half of it, at most the following speed; half of the recent measured speed
//! required travel  since the position where the hitch was last ahead of it
//! standstill       required travel - measured travel > allowance
//! ```
//!
//! * The margin of the current covers a threshold offset and the hysteresis of coil and spool.
//! * The lags cover slow spools, and loads on oil with air. A falling current reduces the required speed at once: no
//!   spool closes faster.
//! * The lag of the angle sensor (`sensors.angle_lag`) is added to these. The measured recent speed already contains it.
//! * Share and following speed cover a load that stands still behind an open valve. A braked load on soft oil
//!   oscillates, and stands still for up to 0.1 s at its reversals. A load that is lifted from the ground first moves
//!   by the spring of the ground, which looks like a start, and then waits for its pressure, which the pump raises by
//!   some 0.1 bar/ms. In such a standstill the valve curve, less the margin, predicted up to 12 mm for healthy
//!   machines, and the longest took 98 ms. They also cover a light load behind the lowering valve, cold oil, a slow
//!   pump, and droop.
//! * A hitch that stops within milliseconds is none of these: half of the recent measured speed is required. Its
//!   average over 24 ms falls with a braked load.
//! * The allowance covers noise and converter steps.
//!
//! So little or no travel is required of a creeping hitch, a correction or a sticking spool, and the allowance is
//! exceeded in 20 ms by a fast one.
//!
//! No travel is required of a hitch that cannot move: near an end of its travel, on the ground (no pressure behind the
//! lowering valve), or with the pump at its relief pressure. Without a pressure sensor a hitch that stops while it is
//! lowered may be on the ground or have a frozen sensor; with half of its pressure lost it is on the ground with part
//! of its weight. The lowering coil then is cut until the command has been off ([`Standstill::GroundContact`]). This is
//! no fault: the hitch stops in either case.

use hitch_quantities::calibration::design_parameters::SafetyParameters;
use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, MilliAmp, MilliBar, MilliDegree};
use hitch_quantities::{CoilCurrents, Inputs};

use crate::limits::{Limits, MachineModel};

/// The speed that is seen is averaged over this many steps; over 64 a load that swings to a standstill would
/// still have 0.1 m/s then.
const AVERAGE_STEPS: i32 = 24;

/// Averages of the angle sensor.
#[derive(Clone, Copy, Debug)]
pub struct AngleReading {
    /// Mean of the samples of 16 ms.
    pub mean: MilliDegree,
    /// Mean of the latest 8.
    pub latest: MilliDegree,
    /// Five sigmas of the difference of two such means.
    pub noise: MilliDegree,
}

/// Result for a hitch that stands still although travel is required.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standstill {
    /// The hitch or its angle sensor has failed.
    Fault,
    /// A lowered hitch that may be on the ground; its pressure is not known.
    GroundContact,
}

/// The monitor, while one coil is energised.
#[derive(Clone, Copy, Debug, Default)]
pub struct FollowingMonitor {
    /// Motion has been detected since the coil was switched on.
    started: bool,
    /// Travel that the currents have given by the valve curves, of a hitch that has yet to start, in millionths of a
    /// degree.
    predicted_udeg: i32,
    /// The part of it that was given by currents above the threshold and the margin.
    required_udeg: i32,
    /// The part of that which the sensor has yet to show.
    hidden_udeg: i32,
    /// Rocker angle for a piston travel of a millimetre here, in thousandths of a degree.
    degrees: i32,
    /// Expected piston speed along the coil's way, of a hitch that has started, and of one that lately moved.
    expected: ExpectedSpeed,
    running: ExpectedSpeed,
    /// The former, behind the lag of the sensor.
    shown: MicrometrePerSecond,
    /// Travel that is required since the hitch was at `from`, in nanometres.
    required_nm: i32,
    from: Option<Micrometre>,
    /// Angle at which the coil was switched on.
    rest: Option<MilliDegree>,
    /// The last travel, and the speed lately seen, in nanometres a step times [`AVERAGE_STEPS`].
    last: Option<Micrometre>,
    measured_speed_sum: i32,
    /// Peak pressure in the cylinder.
    peak_pressure: MilliBar,
}

impl FollowingMonitor {
    /// Current limit until motion has been detected; none for a slow start.
    pub fn onset_limit(&self, slow_start: bool, limits: Limits<'_>) -> Option<CoilCurrents> {
        let (machine, safety) = (limits.machine, limits.safety);
        if self.started || slow_start {
            return None;
        }
        let left = safety.onset_budget - MilliDegree(self.predicted_udeg / 1_000);
        let left = left.0.saturating_mul(1_000) / self.degrees.max(1);
        let speed = MicrometrePerSecond(
            safety
                .onset_time
                .divisor()
                .divide(left.saturating_mul(1_000)),
        );
        let floors = [safety.lift_onset_speed, safety.lower_onset_speed];
        Some(machine.currents(floors.map(|floor| speed.max(floor))))
    }

    /// One step with the regulated currents of the last one. `slow_start`: nothing is required before motion.
    pub fn judge(
        &mut self,
        shown: AngleReading,
        passed: CoilCurrents,
        slow_start: bool,
        inputs: &Inputs,
        limits: Limits<'_>,
    ) -> Option<Standstill> {
        let (machine, safety) = (limits.machine, limits.safety);
        let angle = shown.mean;
        let lifts = passed.lift > MilliAmp::ZERO;
        let travel = machine.linkage.travel(angle);
        let along = if lifts { travel } else { -travel };
        let from = *self.from.get_or_insert(along);
        let held = is_held(angle, lifts, inputs, machine, safety);
        let moved = along - from;
        self.degrees = machine.degrees(angle);
        let stands = if !self.started {
            let shift = if lifts {
                shown.latest - *self.rest.get_or_insert(angle)
            } else {
                *self.rest.get_or_insert(angle) - shown.latest
            };
            let most = shown.noise + safety.onset_travel;
            self.started = shift > most;
            let backwards = shift < -most;
            if backwards {
                self.rest = None;
            }
            let held = held || slow_start;
            let allowance = onset_allowance(angle, lifts, machine, safety);
            self.onset_deficit(backwards, held, passed, limits) > allowance
        } else {
            self.exceeds_allowance(moved, along, held, passed, limits)
        };
        if self.required_nm == 0 {
            self.from = Some(along);
        }
        let hangs = self.carries_load(inputs);
        stands.then_some(if lifts || hangs {
            Standstill::Fault
        } else {
            Standstill::GroundContact
        })
    }

    /// True if the pressure shows that the oil carries the load: below half of its peak the load is on the ground.
    fn carries_load(&mut self, inputs: &Inputs) -> bool {
        inputs.cylinder_pressure.is_some_and(|pressure| {
            self.peak_pressure = self.peak_pressure.max(pressure);
            pressure.0 >= self.peak_pressure.0 / 2
        })
    }

    /// Before motion: the predicted travel above the margin.
    fn onset_deficit(
        &mut self,
        backwards: bool,
        held: bool,
        passed: CoilCurrents,
        limits: Limits<'_>,
    ) -> MilliDegree {
        let (machine, safety) = (limits.machine, limits.safety);
        if self.started || held || backwards {
            self.required_nm = 0;
            self.required_udeg = 0;
            self.hidden_udeg = 0;
            self.predicted_udeg = 0;
            return MilliDegree::ZERO;
        }
        let given = machine.speed(passed, MilliAmp::ZERO).0;
        let given = given.saturating_mul(self.degrees) / 1_000;
        self.predicted_udeg = self.predicted_udeg.saturating_add(given);
        if machine.speed(passed, safety.following_margin) > MicrometrePerSecond::ZERO {
            self.required_udeg = self.required_udeg.saturating_add(given);
            self.hidden_udeg = self.hidden_udeg.saturating_add(given);
        }
        let lag = limits.sensors.angle_lag.divisor();
        self.hidden_udeg = self
            .hidden_udeg
            .saturating_sub(lag.divide(self.hidden_udeg));
        let shown = self.required_udeg.saturating_sub(self.hidden_udeg);
        MilliDegree(shown / 1_000)
    }

    /// After the start: true if the missing travel exceeds the allowance.
    fn exceeds_allowance(
        &mut self,
        moved: Micrometre,
        along: Micrometre,
        held: bool,
        passed: CoilCurrents,
        limits: Limits<'_>,
    ) -> bool {
        let (machine, safety) = (limits.machine, limits.safety);
        let lag = safety.following_lag.divisor();
        let margin = safety.following_margin;
        self.expected
            .follow(machine.speed(passed, margin), safety.started_lag.divisor());
        self.running
            .follow(machine.speed(passed, MilliAmp(margin.0 / 2)), lag);
        let sensor = limits.sensors.angle_lag.divisor();
        self.shown = behind(self.expected.speed, self.shown, sensor);
        self.average_speed(along);
        let required = self.required_speed(safety);
        self.required_nm = self.required_nm.saturating_add(required.0);
        let required = Micrometre(self.required_nm / 1_000);
        // Any motion beyond noise shows a sensor that lives, also that of a load that swings back.
        let alive = Micrometre(safety.following_allowance.0 / 4);
        if held || moved.magnitude() >= required.min(alive) {
            self.required_nm = 0;
            return false;
        }
        required > safety.following_allowance
    }

    /// Averages the measured speed.
    fn average_speed(&mut self, along: Micrometre) {
        let step = along - self.last.unwrap_or(along);
        self.last = Some(along);
        let forgotten = self.measured_speed_sum / AVERAGE_STEPS;
        self.measured_speed_sum = self
            .measured_speed_sum
            .saturating_add(step.0.saturating_mul(1_000))
            .saturating_sub(forgotten);
    }

    /// Required speed: a share of the expected one, or half of the recent measured speed that the current still gives.
    fn required_speed(&self, safety: &SafetyParameters) -> MicrometrePerSecond {
        let half = |speed: MicrometrePerSecond| MicrometrePerSecond(speed.0 / 2);
        let expected = self.shown;
        let started = expected.scaled(safety.following_share.0, Divisor::at_least_one(1_000));
        let least = half(expected).min(safety.following_speed);
        let lately = MicrometrePerSecond(self.measured_speed_sum / AVERAGE_STEPS);
        started.max(least).max(half(lately.min(self.running.speed)))
    }
}

/// A speed after two equal lags.
#[derive(Clone, Copy, Debug, Default)]
struct ExpectedSpeed {
    /// After the first.
    opening: MicrometrePerSecond,
    /// After both.
    speed: MicrometrePerSecond,
}

impl ExpectedSpeed {
    /// One step: rises slowly towards `target`, falls with it.
    fn follow(&mut self, target: MicrometrePerSecond, lag: Divisor) {
        self.opening = behind(target, self.opening, lag);
        self.speed = behind(self.opening, self.speed, lag);
    }
}

/// One step of a speed that rises slowly towards `target`, and falls with it.
fn behind(
    target: MicrometrePerSecond,
    speed: MicrometrePerSecond,
    lag: Divisor,
) -> MicrometrePerSecond {
    let step = lag.divide((target - speed).0);
    target.min(speed + MicrometrePerSecond(step))
}

/// Allowed missing travel at the start: more at the lower end stop, which carried the load.
fn onset_allowance(
    angle: MilliDegree,
    lifts: bool,
    machine: MachineModel<'_>,
    safety: &SafetyParameters,
) -> MilliDegree {
    if lifts && angle <= machine.ends().0 + safety.end_zone {
        safety.onset_debt + safety.stop_debt
    } else {
        safety.onset_debt
    }
}

/// True if something else than a valve may hold the hitch: an end, the ground, or more load than the pump can lift.
fn is_held(
    angle: MilliDegree,
    lifts: bool,
    inputs: &Inputs,
    machine: MachineModel<'_>,
    safety: &SafetyParameters,
) -> bool {
    let hydraulics = machine.hydraulics;
    if lifts {
        let full = hydraulics.relief_pressure - hydraulics.relief_margin;
        angle >= machine.ends().1 - safety.end_zone
            || inputs
                .pump_pressure
                .is_some_and(|pressure| pressure >= full)
    } else {
        angle <= machine.ends().0 + safety.end_zone
            || inputs
                .cylinder_pressure
                .is_some_and(|pressure| pressure <= hydraulics.smallest_drop)
    }
}
