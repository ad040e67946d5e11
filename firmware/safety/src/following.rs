//! Compares the travel that an energised coil must have caused with the travel that the angle shows.
//!
//! The samples of an angle sensor that sticks in motion, or just as the coil comes on, can look like those of a good one:
//! it may keep its noise, and a good one may have none. But a coil that has had a current for some time moves the hitch,
//! whatever the controller has done with that current since. So this watch works out the least travel that a healthy
//! machine owes for the currents that were passed, and compares it with what is seen.
//!
//! A stroke has two parts. Before motion is seen, nobody knows how late this machine starts: it may lie on the ground,
//! compress its oil, or have a slow spool. There the travel that the valve curve gives for the passed currents is
//! limited:
//!
//! ```text
//! given travel  sum of valve curve(current)
//! cap           (onset budget - given travel) / onset time, at least the onset speed
//! standstill    given travel, where the current is above threshold + margin, > onset debt
//! ```
//!
//! A hitch that is lifted off its lower end stop may owe the stop debt as well: the stop carried the load, and its oil has no
//! pressure.
//!
//! Once motion has been seen:
//!
//! ```text
//! expected     current less margin -> flow of the valve curve -> piston speed -> two lags
//! owed speed   a share of that; half of it, at most the following speed; half of the speed lately seen
//! owed travel  since the place where the hitch was last ahead of it
//! standstill   owed travel - seen travel > allowance
//! ```
//!
//! * The margin on the current covers a threshold that is off and the hysteresis of coil and spool.
//! * The lags cover slow spools, and loads on oil with air in it. A current that falls takes the owed speed with it at
//!   once: no spool closes faster.
//! * Share and following speed cover a load that stands although its valve is open. A load on soft oil that was braked
//!   swings, and stands for up to 0.1 s where its speed would turn round. A load that is taken up from the ground first
//!   moves by the spring of the ground, which looks like a start, and then waits for the pressure that carries it: the pump
//!   raises it by some 0.1 bar/ms. Healthy machines were given up to 12 mm by the valve curve, less the margin, in such a
//!   standstill, and the longest took 98 ms. They also cover a light load behind the lowering valve, cold oil, a slow
//!   pump, and droop.
//! * A hitch that ran and stops within milliseconds is none of these: half of the speed lately seen is owed. The average over
//!   24 ms of it falls with a load that is braked.
//! * The allowance covers noise and converter steps.
//!
//! So a creeping hitch, a correction or a spool that sticks owes little or nothing, a fast one its allowance in 20 ms.
//!
//! A hitch that can't go on owes nothing: near an end of its travel, on the ground (no pressure behind the lowering
//! valve), or with the pump at its relief pressure. Without a sensor of pressure a hitch that stops while it is lowered
//! may lie on the ground as well as have a frozen sensor, and one whose pressure has fallen by half lies on it with part
//! of its weight. Then the lowering coil is cut until the command was off ([`Standstill::Landed`]), which is no fault: the
//! hitch stops either way.

use hitch_quantities::calibration::design_parameters::{HydraulicParameters, SafetyParameters};
use hitch_quantities::calibration::linkage::LinkageTable;
use hitch_quantities::calibration::valve_table::ValveTable;
use hitch_quantities::fixed::Divisor;
use hitch_quantities::piston::{flow, piston_speed};
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, MilliAmp, MilliBar, MilliDegree};
use hitch_quantities::{Calibration, CoilCurrents, Inputs};

use crate::Limits;

/// The speed that is seen is averaged over this many steps; over 64 a load that swings to a standstill would
/// still have 0.1 m/s then.
const SEEN_STEPS: i32 = 24;

/// What the watch knows of the machine.
#[derive(Clone, Copy, Debug)]
pub struct Machine<'a> {
    /// Lift valve.
    lift: &'a ValveTable,
    /// Lowering valve.
    lower: &'a ValveTable,
    /// Rocker angle to piston travel.
    linkage: &'a LinkageTable,
    /// Hydraulic circuit.
    hydraulics: &'a HydraulicParameters,
    /// Lowest and highest set point, just inside the ends of the travel.
    ends: (MilliDegree, MilliDegree),
}

impl<'a> Machine<'a> {
    /// The machine of a calibration.
    #[must_use]
    pub const fn of(calibration: &'a Calibration) -> Self {
        Self {
            lift: &calibration.lift,
            lower: &calibration.lower,
            linkage: &calibration.linkage,
            hydraulics: &calibration.hydraulics,
            ends: (
                calibration.position.lower_limit,
                calibration.position.upper_limit,
            ),
        }
    }

    /// Piston speed that the currents less a margin give.
    fn speed(self, passed: CoilCurrents, margin: MilliAmp) -> MicrometrePerSecond {
        let (table, current) = match passed.lift > MilliAmp::ZERO {
            true => (self.lift, passed.lift),
            false => (self.lower, passed.lower),
        };
        piston_speed(table.flow(current - margin), self.hydraulics.piston_area)
    }

    /// Rocker angle for a piston travel of a millimetre at an angle, in thousandths of a degree.
    fn degrees(self, angle: MilliDegree) -> i32 {
        let half = MilliDegree(1_000);
        let way = self.linkage.travel(angle + half) - self.linkage.travel(angle - half);
        2_000_000 / way.0.max(1)
    }

    /// The currents that give a piston speed by the valve curves.
    fn currents(self, speed: [MicrometrePerSecond; 2]) -> CoilCurrents {
        let [lift, lower] = speed.map(|speed| flow(speed, self.hydraulics.piston_area));
        CoilCurrents {
            lift: self.lift.current(lift),
            lower: self.lower.current(lower),
        }
    }
}

/// What the sensor shows.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    /// Mean of the samples of 16 ms.
    pub mean: MilliDegree,
    /// Mean of the latest 8.
    pub latest: MilliDegree,
    /// Five sigmas of the difference of two such means.
    pub noise: MilliDegree,
}

/// What stands still although it owes travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standstill {
    /// The hitch, or the angle that is shown of it.
    Fault,
    /// A hitch that was lowered, and may have come to the ground: nothing is known of its pressure.
    Landed,
}

/// The watch, while one coil is energised.
#[derive(Clone, Copy, Debug, Default)]
pub struct Following {
    /// Motion has been seen since the coil came on.
    started: bool,
    /// Travel that the currents have given by the valve curves, of a hitch that has yet to start, in millionths of a
    /// degree.
    given_udeg: i32,
    /// The part of it that was given by currents above the threshold and the margin.
    owed_udeg: i32,
    /// Rocker angle for a piston travel of a millimetre here, in thousandths of a degree.
    degrees: i32,
    /// Expected piston speed along the coil's way, of a hitch that has started, and of one that lately moved.
    expected: Expected,
    running: Expected,
    /// Travel that is owed since the hitch was at `from`, in nanometres.
    owed_nm: i32,
    from: Option<Micrometre>,
    /// Where the coil came on.
    rest: Option<MilliDegree>,
    /// The last travel, and the speed lately seen, in nanometres a step times [`SEEN_STEPS`].
    last: Option<Micrometre>,
    seen_lately: i32,
    /// Highest pressure in the cylinder.
    most_pressure: MilliBar,
}

impl Following {
    /// Most that the coils get until motion has been seen.
    pub fn gentle(&self, limits: Limits<'_>) -> Option<CoilCurrents> {
        let (machine, safety) = (limits.machine, limits.safety);
        if self.started || limits.slow_start {
            return None;
        }
        let left = safety.onset_budget - MilliDegree(self.given_udeg / 1_000);
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

    /// One step with the currents that were passed in the last one.
    pub fn judge(
        &mut self,
        shown: Shown,
        passed: CoilCurrents,
        inputs: &Inputs,
        limits: Limits<'_>,
    ) -> Option<Standstill> {
        let (machine, safety) = (limits.machine, limits.safety);
        let angle = shown.mean;
        let lifts = passed.lift > MilliAmp::ZERO;
        let travel = machine.linkage.travel(angle);
        let along = match lifts {
            true => travel,
            false => -travel,
        };
        let from = *self.from.get_or_insert(along);
        let held = is_held(angle, lifts, inputs, machine, safety);
        let moved = along - from;
        self.degrees = machine.degrees(angle);
        let stands = match self.started {
            false => {
                let shift = match lifts {
                    true => shown.latest - *self.rest.get_or_insert(angle),
                    false => *self.rest.get_or_insert(angle) - shown.latest,
                };
                let most = shown.noise + safety.onset_travel;
                self.started = shift > most;
                let backwards = shift < -most;
                if backwards {
                    self.rest = None;
                }
                let held = held || limits.slow_start;
                let debt = onset_debt(angle, lifts, machine, safety);
                self.starts(backwards, held, passed, machine, safety) > debt
            }
            true => self.follows(moved, along, held, passed, machine, safety),
        };
        if self.owed_nm == 0 {
            self.from = Some(along);
        }
        let hangs = self.hangs(inputs);
        stands.then_some(match lifts || hangs {
            true => Standstill::Fault,
            false => Standstill::Landed,
        })
    }

    /// True if a pressure is known that shows a load on the oil: less than half of what it was lies on the ground.
    fn hangs(&mut self, inputs: &Inputs) -> bool {
        inputs.cylinder_pressure.is_some_and(|pressure| {
            self.most_pressure = self.most_pressure.max(pressure);
            pressure.0 >= self.most_pressure.0 / 2
        })
    }

    /// A hitch that has yet to start; the travel that it owes.
    fn starts(
        &mut self,
        backwards: bool,
        held: bool,
        passed: CoilCurrents,
        machine: Machine<'_>,
        safety: &SafetyParameters,
    ) -> MilliDegree {
        if self.started || held || backwards {
            self.owed_nm = 0;
            self.owed_udeg = 0;
            self.given_udeg = 0;
            return MilliDegree::ZERO;
        }
        let given = machine.speed(passed, MilliAmp::ZERO).0;
        let given = given.saturating_mul(self.degrees) / 1_000;
        self.given_udeg = self.given_udeg.saturating_add(given);
        if machine.speed(passed, safety.following_margin) > MicrometrePerSecond::ZERO {
            self.owed_udeg = self.owed_udeg.saturating_add(given);
        }
        MilliDegree(self.owed_udeg / 1_000)
    }

    /// A hitch that has started; true if it owes more than noise hides.
    fn follows(
        &mut self,
        moved: Micrometre,
        along: Micrometre,
        held: bool,
        passed: CoilCurrents,
        machine: Machine<'_>,
        safety: &SafetyParameters,
    ) -> bool {
        let lag = safety.following_lag.divisor();
        let margin = safety.following_margin;
        self.expected
            .follow(machine.speed(passed, margin), safety.started_lag.divisor());
        self.running
            .follow(machine.speed(passed, MilliAmp(margin.0 / 2)), lag);
        self.see(along);
        let owed = self.owed_speed(safety);
        self.owed_nm = self.owed_nm.saturating_add(owed.0);
        let owed = Micrometre(self.owed_nm / 1_000);
        // Any motion beyond noise shows a sensor that lives, also that of a load that swings back.
        let alive = Micrometre(safety.following_allowance.0 / 4);
        if held || moved.magnitude() >= owed.min(alive) {
            self.owed_nm = 0;
            return false;
        }
        owed > safety.following_allowance
    }

    /// Averages the speed that is seen.
    fn see(&mut self, along: Micrometre) {
        let step = along - self.last.unwrap_or(along);
        self.last = Some(along);
        let forgotten = self.seen_lately / SEEN_STEPS;
        self.seen_lately = self
            .seen_lately
            .saturating_add(step.0.saturating_mul(1_000))
            .saturating_sub(forgotten);
    }

    /// Speed that is owed now: of a hitch that has started, or half of what it lately had and the current still gives.
    fn owed_speed(&self, safety: &SafetyParameters) -> MicrometrePerSecond {
        let half = |speed: MicrometrePerSecond| MicrometrePerSecond(speed.0 / 2);
        let expected = self.expected.speed;
        let started = expected.scaled(safety.following_share.0, Divisor::at_least_one(1_000));
        let least = half(expected).min(safety.following_speed);
        let lately = MicrometrePerSecond(self.seen_lately / SEEN_STEPS);
        started.max(least).max(half(lately.min(self.running.speed)))
    }
}

/// A speed behind two equal lags.
#[derive(Clone, Copy, Debug, Default)]
struct Expected {
    /// Behind one of them.
    opening: MicrometrePerSecond,
    /// Behind both.
    speed: MicrometrePerSecond,
}

impl Expected {
    /// One step: rises slowly towards `target`, falls with it.
    fn follow(&mut self, target: MicrometrePerSecond, lag: Divisor) {
        let behind = |target: MicrometrePerSecond, speed: MicrometrePerSecond| {
            let step = lag.divide((target - speed).0);
            target.min(speed + MicrometrePerSecond(step))
        };
        self.opening = behind(target, self.opening);
        self.speed = behind(self.opening, self.speed);
    }
}

/// Travel that a hitch may owe at its start: more as it comes off the lower end stop, which carried its load.
fn onset_debt(
    angle: MilliDegree,
    lifts: bool,
    machine: Machine<'_>,
    safety: &SafetyParameters,
) -> MilliDegree {
    match lifts && angle <= machine.ends.0 + safety.end_zone {
        true => safety.onset_debt + safety.stop_debt,
        false => safety.onset_debt,
    }
}

/// True if something else than a valve may hold the hitch: an end, the ground, or more load than the pump can lift.
fn is_held(
    angle: MilliDegree,
    lifts: bool,
    inputs: &Inputs,
    machine: Machine<'_>,
    safety: &SafetyParameters,
) -> bool {
    let hydraulics = machine.hydraulics;
    match lifts {
        true => {
            let full = hydraulics.relief_pressure - hydraulics.relief_margin;
            angle >= machine.ends.1 - safety.end_zone
                || inputs
                    .pump_pressure
                    .is_some_and(|pressure| pressure >= full)
        }
        false => {
            angle <= machine.ends.0 + safety.end_zone
                || inputs
                    .cylinder_pressure
                    .is_some_and(|pressure| pressure <= hydraulics.smallest_drop)
        }
    }
}
