//! Teaching: the firmware identifies the threshold currents and the spool lags of both valves, and the ends of travel.
//!
//! It starts from the lock with a service switch and a held button, and ends when the button is released. It consists
//! of several current ramps for each valve, up and down in turn, one move to each end, and a current step for each
//! valve:
//!
//! ```text
//! +------+   rested    +------+  moved   +------+        +------+  over          +------+
//! | Rest | ----------> | Ramp | -------> | Rest | -...-> | Open | -------------> | Done |
//! +------+             +------+          +------+        +------+  (both valves) +------+
//!     ^    after the   +-------+  still     ^
//!     +--- ramps ----> | Drive | -----------+
//!                      +-------+
//! ```
//!
//! A step moves the hitch by a fifth of its travel, a heavy one further down than up. Contact with an end during a step
//! would look like another valve. Therefore the steps come last and start at the lower end. Steps in the lowest quarter
//! are not evaluated: they only move the hitch out of it.
//!
//! A ramp rises until the hitch has moved further than noise. The current then exceeds the threshold by an amount that
//! depends on ramp, valve, spool and filter. Therefore a model (the *twin*) follows the same ramp with the curve of the
//! calibration. At the same travel, its current differs from the real one by the error of the threshold.

use hitch_quantities::calibration::design_parameters::TeachParameters;
use hitch_quantities::calibration::linkage::LinkageTable;
use hitch_quantities::calibration::valve_table::ValveTable;
use hitch_quantities::fixed::{Divisor, behind};
use hitch_quantities::units::{Micrometre, MilliAmp, MilliDegree, Millisecond};
use hitch_quantities::{Calibration, CoilCurrents};

use super::teach_lag::{STEP, Way};
use super::teach_twin::Twin;
use super::{teach_hysteresis, teach_lag};
use crate::adaptation::threshold_offset::INITIAL_LIFT_OFFSET;
use crate::estimation::spool_lag::nominal_lags;
use crate::valve::drop_scale::DropScale;
use crate::valve::phase::Direction;

/// Ramps for each valve.
pub const REPEATS: usize = 3;
/// Ramps of both valves, and a move to each end.
const RAMPS: usize = 2 * REPEATS;
const RAMPS_AND_DRIVES: usize = RAMPS + 2;

/// Reason for which teaching failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TeachError {
    /// Button or switch was released, or a fault occurred.
    Aborted,
    /// The hitch does not move at the largest current of a ramp, or does not reach an end.
    NoMotion,
    /// A threshold is further from the calibrated one than the spread of these valves.
    OutOfRange,
    /// The ramps of a valve do not agree.
    Spread,
    /// The ends of travel do not fit the linkage.
    Ends,
}

/// The result.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taught {
    /// Shift of the lift curve.
    pub lift_shift: MilliAmp,
    /// Shift of the lowering curve.
    pub lower_shift: MilliAmp,
    /// Lag of the lift valve's spool.
    pub lift_lag: Millisecond,
    /// Lag of the lowering valve's spool.
    pub lower_lag: Millisecond,
    /// Hysteresis of both valves.
    pub hysteresis: MilliAmp,
    /// Angle at the lower end.
    pub lower_end: MilliDegree,
    /// Angle at the upper end.
    pub upper_end: MilliDegree,
}

impl Taught {
    /// The calibration with the result, sealed: curves shifted, linkage moved to the sensor, limits inside the ends.
    #[must_use]
    pub fn applied_to(&self, calibration: &Calibration) -> Calibration {
        let mut taught = calibration.clone();
        // The initial offset of an untaught lift valve is part of the identified shift.
        shift(&mut taught.lift, self.lift_shift - INITIAL_LIFT_OFFSET);
        shift(&mut taught.lower, self.lower_shift);
        taught.hydraulics.spool_lag = self.lift_lag;
        taught.hydraulics.lower_spool_lag = self.lower_lag;
        taught.hydraulics.hysteresis = self.hysteresis;
        let offset = mean_offset(self.lower_end, self.upper_end, calibration);
        taught.linkage.first_angle = taught.linkage.first_angle + offset;
        let margin = calibration.teach.end_margin;
        taught.position.lower_limit = self.lower_end + margin;
        taught.position.upper_limit = self.upper_end - margin;
        taught.sealed()
    }
}

fn shift(table: &mut ValveTable, by: MilliAmp) {
    let used = usize::try_from(table.count).unwrap_or(0);
    for point in table.points.iter_mut().take(used) {
        point.current = point.current + by;
    }
}

/// Ends according to the linkage.
fn expected_ends(linkage: &LinkageTable, parameters: &TeachParameters) -> [MilliDegree; 2] {
    [Micrometre::ZERO, parameters.stroke].map(|travel| linkage.angle(travel))
}

fn mean_offset(lower: MilliDegree, upper: MilliDegree, calibration: &Calibration) -> MilliDegree {
    let [low, high] = expected_ends(&calibration.linkage, &calibration.teach);
    let sum = (lower - low) + (upper - high);
    MilliDegree(Divisor::at_least_one(2).divide(sum.0))
}

/// Stage of teaching.
#[derive(Clone, Copy, Debug)]
enum TeachStage {
    Rest(Millisecond),
    Ramp(Ramp),
    Open(Opening),
    Drive(TeachDrive),
    Done,
}

/// Current ramp, with the model of the calibrated curve.
#[derive(Clone, Copy, Debug)]
struct Ramp {
    start: Micrometre,
    current_ua: i32,
    twin: Twin,
    /// Current at which the hitch had moved, and that of the twin.
    moved_at: Option<MilliAmp>,
    twin_at: Option<MilliAmp>,
}

/// Response to a current step, and that of the model.
#[derive(Clone, Copy, Debug)]
struct Opening {
    start: Micrometre,
    age: Millisecond,
    twin: Twin,
    /// Of the hitch and of the twin.
    ways: [Way; 2],
}

/// Move to an end of the travel.
#[derive(Clone, Copy, Debug)]
struct TeachDrive {
    looked: Micrometre,
    age: Millisecond,
    total: Millisecond,
}

/// The procedure.
#[derive(Clone, Copy, Debug)]
pub struct Teach {
    step: TeachStage,
    /// Completed ramps, moves and steps.
    finished: usize,
    filtered_udeg: Option<i32>,
    shifts: [[MilliAmp; REPEATS]; 2],
    lags: [Millisecond; 2],
    /// The smaller result so far.
    hysteresis: MilliAmp,
    ends: [MilliDegree; 2],
    result: Option<Result<Taught, TeachError>>,
}

impl Default for Teach {
    fn default() -> Self {
        Self {
            step: TeachStage::Rest(Millisecond::ZERO),
            finished: 0,
            filtered_udeg: None,
            shifts: [[MilliAmp::ZERO; REPEATS]; 2],
            lags: [Millisecond::ZERO; 2],
            hysteresis: MilliAmp(i32::MAX),
            ends: [MilliDegree::ZERO; 2],
            result: None,
        }
    }
}

impl Teach {
    /// The result, once teaching has ended.
    #[must_use]
    pub const fn result(&self) -> Option<Result<Taught, TeachError>> {
        self.result
    }

    /// Teaching failed.
    pub fn abort(&mut self) {
        self.end(Err(TeachError::Aborted));
    }

    fn end(&mut self, result: Result<Taught, TeachError>) {
        self.result = self.result.or(Some(result));
        self.step = TeachStage::Done;
    }

    /// One step; the requested currents.
    pub fn step(
        &mut self,
        angle: MilliDegree,
        scale: DropScale,
        calibration: &Calibration,
    ) -> CoilCurrents {
        let travel = calibration
            .linkage
            .travel(self.filtered(angle, calibration));
        let direction = self.direction();
        let outcome = match self.step {
            TeachStage::Rest(rested) => Ok(self.rest(rested, travel, calibration)),
            TeachStage::Ramp(ramp) => self.ramp(ramp, direction, travel, scale, calibration),
            TeachStage::Open(opening) => {
                Ok(self.open(opening, direction, travel, scale, calibration))
            }
            TeachStage::Drive(drive) => self.drive(drive, direction, travel, calibration),
            TeachStage::Done => Ok(MilliAmp::ZERO),
        };
        let current = outcome.unwrap_or_else(|error| {
            self.end(Err(error));
            MilliAmp::ZERO
        });
        let (mut lift, mut lower) = (MilliAmp::ZERO, MilliAmp::ZERO);
        match direction {
            Direction::Lift => lift = current,
            Direction::Lower => lower = current,
        }
        CoilCurrents { lift, lower }
    }

    /// Ramps alternate between up and down.
    const fn direction(&self) -> Direction {
        match self.finished % 2 {
            0 => Direction::Lift,
            _ => Direction::Lower,
        }
    }

    /// The angle, low-passed.
    fn filtered(&mut self, angle: MilliDegree, calibration: &Calibration) -> MilliDegree {
        let now = angle.0.saturating_mul(1000);
        let before = self.filtered_udeg.unwrap_or(now);
        let time = calibration.teach.filter_time.divisor();
        let next = behind(before, now, time);
        self.filtered_udeg = Some(next);
        MilliDegree(Divisor::THOUSAND.divide(next))
    }

    fn rest(
        &mut self,
        rested: Millisecond,
        travel: Micrometre,
        calibration: &Calibration,
    ) -> MilliAmp {
        let parameters = &calibration.teach;
        self.step = if rested < parameters.rest_time {
            TeachStage::Rest(rested.next())
        } else if self.finished < RAMPS {
            TeachStage::Ramp(Ramp {
                start: travel,
                current_ua: parameters.ramp_start.0.saturating_mul(1000),
                twin: Twin::default(),
                moved_at: None,
                twin_at: None,
            })
        } else if self.finished < RAMPS_AND_DRIVES {
            TeachStage::Drive(TeachDrive {
                looked: travel,
                // A cylinder that was pressed against its end first has to release 150 bar.
                age: -parameters.rest_time,
                total: Millisecond::ZERO,
            })
        } else {
            TeachStage::Open(Opening {
                start: travel,
                age: Millisecond::ZERO,
                twin: Twin::default(),
                ways: Default::default(),
            })
        };
        MilliAmp::ZERO
    }

    /// One step of a ramp. The coil is cut once the hitch has moved; the twin continues until it has moved as far.
    fn ramp(
        &mut self,
        mut ramp: Ramp,
        direction: Direction,
        travel: Micrometre,
        scale: DropScale,
        calibration: &Calibration,
    ) -> Result<MilliAmp, TeachError> {
        let parameters = &calibration.teach;
        // A milliampere per second is a microampere per millisecond.
        ramp.current_ua = ramp.current_ua.saturating_add(parameters.ramp_slope.0);
        let current = MilliAmp(Divisor::THOUSAND.divide(ramp.current_ua));
        let moved = Micrometre(direction.sign((travel - ramp.start).0));
        if moved >= parameters.moved {
            ramp.moved_at = ramp.moved_at.or(Some(current));
        }
        if ramp
            .twin
            .step(ramp.current_ua, direction, scale, calibration)
            >= parameters.moved
        {
            ramp.twin_at = ramp.twin_at.or(Some(current));
        }
        self.step = TeachStage::Ramp(ramp);
        if let Some((moved_at, twin_at)) = ramp.moved_at.zip(ramp.twin_at) {
            self.note_shift(moved_at - twin_at, direction, parameters)?;
            return Ok(MilliAmp::ZERO);
        }
        if current > parameters.ramp_end {
            return Err(TeachError::NoMotion);
        }
        Ok(match ramp.moved_at {
            Some(_) => MilliAmp::ZERO,
            None => current,
        })
    }

    fn note_shift(
        &mut self,
        shift: MilliAmp,
        direction: Direction,
        parameters: &TeachParameters,
    ) -> Result<(), TeachError> {
        if shift.magnitude() > parameters.most_shift {
            return Err(TeachError::OutOfRange);
        }
        let [lift, lower] = &mut self.shifts;
        let shifts = match direction {
            Direction::Lift => lift,
            Direction::Lower => lower,
        };
        if let Some(slot) = shifts.get_mut(self.finished / 2) {
            *slot = shift;
        }
        self.finished = self.finished.saturating_add(1);
        self.step = TeachStage::Rest(Millisecond::ZERO);
        if self.finished < RAMPS {
            return Ok(());
        }
        if self
            .shifts
            .iter()
            .all(|shifts| spread(shifts) <= parameters.most_spread)
        {
            Ok(())
        } else {
            Err(TeachError::Spread)
        }
    }

    /// One step of a current step, which ends once the speed is constant.
    fn open(
        &mut self,
        mut opening: Opening,
        direction: Direction,
        travel: Micrometre,
        scale: DropScale,
        calibration: &Calibration,
    ) -> MilliAmp {
        let valve = self.finished % 2;
        let parameters = &calibration.teach;
        let falling = (opening.age - STEP).max(Millisecond::ZERO).0;
        // A milliampere per second is a microampere per millisecond.
        let current_ua = Self::driving(calibration)[valve]
            .0
            .saturating_mul(1000)
            .saturating_sub(falling.saturating_mul(parameters.ramp_slope.0));
        let to_nominal_currents = MilliAmp(Divisor::THOUSAND.divide(current_ua));
        let travelled = Micrometre(direction.sign((travel - opening.start).0));
        let twin_travelled = opening.twin.step(current_ua, direction, scale, calibration);
        let [real, twin] = &mut opening.ways;
        real.note(opening.age, travelled);
        twin.note(opening.age, twin_travelled);
        opening.age = opening.age.next();
        if to_nominal_currents > parameters.ramp_start {
            self.step = TeachStage::Open(opening);
            return to_nominal_currents + mean(&self.shifts[valve]);
        }
        self.step = TeachStage::Rest(Millisecond::ZERO);
        if opening.start.0 > parameters.stroke.0 >> 2 {
            let [real, twin] = opening.ways;
            self.note_opening(&real, &twin, calibration);
        }
        MilliAmp::ZERO
    }

    fn note_opening(&mut self, real: &Way, twin: &Way, calibration: &Calibration) {
        let valve = self.finished % 2;
        let (motion, hydraulics) = (&calibration.motion, &calibration.hydraulics);
        let usual = [motion.lift_trail, motion.lowering_trail][valve];
        let known = nominal_lags(hydraulics)[valve];
        self.lags[valve] = teach_lag::found(real, twin, usual, known, motion.lag_limit);
        let rate = calibration.teach.ramp_slope;
        let hysteresis = teach_hysteresis::found(real, twin, rate, hydraulics.hysteresis);
        self.hysteresis = self.hysteresis.min(hysteresis);
        self.finished = self.finished.saturating_add(1);
        if valve == 1 {
            self.end(Ok(self.taught()));
        }
    }

    /// The complete result.
    fn taught(&self) -> Taught {
        let [lift_shift, lower_shift] = self.shifts.map(|shifts| mean(&shifts));
        let [lift_lag, lower_lag] = self.lags;
        let [lower_end, upper_end] = self.ends;
        Taught {
            lift_shift,
            lower_shift,
            lift_lag,
            lower_lag,
            hysteresis: self.hysteresis,
            lower_end,
            upper_end,
        }
    }

    /// Currents for a slow move, according to the calibrated curves.
    fn driving(calibration: &Calibration) -> [MilliAmp; 2] {
        let parameters = &calibration.teach;
        [
            calibration.lift.threshold() + parameters.lift_excess,
            calibration.lower.threshold() + parameters.lower_excess,
        ]
    }

    /// One step towards an end. The end is reached when the hitch stands still.
    fn drive(
        &mut self,
        mut drive: TeachDrive,
        direction: Direction,
        travel: Micrometre,
        calibration: &Calibration,
    ) -> Result<MilliAmp, TeachError> {
        let parameters = &calibration.teach;
        drive.age = drive.age.next();
        drive.total = drive.total.next();
        if drive.total > parameters.longest_drive {
            return Err(TeachError::NoMotion);
        }
        if drive.age >= parameters.look_time {
            if (travel - drive.looked).magnitude() < parameters.moved {
                self.note_end(direction, calibration)?;
                return Ok(MilliAmp::ZERO);
            }
            drive.age = Millisecond::ZERO;
            drive.looked = travel;
        }
        self.step = TeachStage::Drive(drive);
        let valve = self.finished % 2;
        Ok(Self::driving(calibration)[valve] + mean(&self.shifts[valve]))
    }

    fn note_end(
        &mut self,
        direction: Direction,
        calibration: &Calibration,
    ) -> Result<(), TeachError> {
        let angle = MilliDegree(Divisor::THOUSAND.divide(self.filtered_udeg.unwrap_or(0)));
        let [lower, upper] = &mut self.ends;
        self.step = TeachStage::Rest(Millisecond::ZERO);
        self.finished = self.finished.saturating_add(1);
        if direction == Direction::Lift {
            *upper = angle;
            return Ok(());
        }
        *lower = angle;
        let [lower_end, upper_end] = self.ends;
        let [low, high] = expected_ends(&calibration.linkage, &calibration.teach);
        let offset = mean_offset(lower_end, upper_end, calibration);
        let most = calibration.teach.most_offset;
        let stretch = (upper_end - lower_end - (high - low)).magnitude();
        if offset.magnitude() > most || stretch > calibration.teach.most_stretch {
            return Err(TeachError::Ends);
        }
        Ok(())
    }
}

fn mean(shifts: &[MilliAmp; REPEATS]) -> MilliAmp {
    const COUNT: Divisor = Divisor::at_least_one(REPEATS as i32);
    let sum = shifts
        .iter()
        .fold(MilliAmp::ZERO, |sum, &shift| sum + shift);
    MilliAmp(COUNT.divide(sum.0))
}

fn spread(shifts: &[MilliAmp; REPEATS]) -> MilliAmp {
    let most = shifts.iter().max().copied().unwrap_or_default();
    let least = shifts.iter().min().copied().unwrap_or_default();
    most - least
}
