//! Compensator logic: flow that is demanded and doesn't arrive.
//!
//! While lifting, flow is what the map says only as long as the compensator has margin. At the relief
//! pressure, at the end of the stroke or against an obstacle the pump's flow goes over the relief valve at 154 bar
//! instead. Seen in the pump pressure if there is a sensor, and in any case by comparing demanded with
//! measured travel. The coil is then cut, and after a rest there are a few more attempts. At the end of its stroke, and on
//! the ground, a hitch stays where it is until the lever is moved: that is no fault.

use hitch_quantities::calibration::design_parameters::{HydraulicParameters, SaturationParameters};
use hitch_quantities::units::{Count, Micrometre, MilliBar, MilliDegree, Millisecond};
use hitch_quantities::{Calibration, Fault};

use crate::estimation::motion::Motion;
use crate::sensing::sensors::Sensed;
use crate::valve::phase::{Direction, Phase};

/// A hitch that stalls this close to a limit of its travel has arrived: an end stop, or a misplaced limit.
const END_ZONE: MilliDegree = MilliDegree(2_000);

/// True if a hitch that has stalled has come as far as it can: to an end of its stroke, or down to the ground.
///
/// What lies on the ground leaves no pressure behind an open valve. Without a sensor a lowering valve that doesn't open
/// looks the same; then nothing sinks, and nothing is unsafe.
#[must_use]
pub fn goes_no_further(lifts: bool, sensed: &Sensed, calibration: &Calibration) -> bool {
    let (position, hydraulics) = (&calibration.position, &calibration.hydraulics);
    let lies = || {
        let empty = |pressure| pressure <= hydraulics.smallest_drop;
        sensed.cylinder_pressure.is_none_or(empty)
    };
    match lifts {
        true => sensed.angle >= position.upper_limit - END_ZONE,
        false => sensed.angle <= position.lower_limit + END_ZONE || lies(),
    }
}

/// Watches whether flow arrives.
#[derive(Clone, Copy, Debug, Default)]
pub struct SaturationWatch {
    window: Option<Window>,
    near_relief: Millisecond,
    attempts: Count,
    resting: Option<Millisecond>,
}

/// One comparison of demanded and measured travel.
#[derive(Clone, Copy, Debug)]
struct Window {
    start: Micrometre,
    demanded_nm: i32,
    age: Millisecond,
}

impl SaturationWatch {
    /// One step; true when flow is demanded and nothing moves.
    pub fn stalled(
        &mut self,
        phase: Phase,
        motion: &Motion,
        pump_pressure: Option<MilliBar>,
        parameters: &SaturationParameters,
        hydraulics: &HydraulicParameters,
    ) -> bool {
        let Phase::Moving { direction, .. } = phase else {
            self.window = None;
            self.near_relief = Millisecond::ZERO;
            return false;
        };
        let full = pump_pressure.is_some_and(|pressure| {
            pressure >= hydraulics.relief_pressure - hydraulics.relief_margin
        });
        self.near_relief = if full && direction == Direction::Lift {
            self.near_relief.next()
        } else {
            Millisecond::ZERO
        };
        self.compare(direction, motion, parameters) || self.near_relief >= parameters.relief_time
    }

    /// The hitch stalled short of an end: rests before the next attempt.
    ///
    /// # Errors
    /// There were too many attempts.
    pub fn rest(&mut self, parameters: &SaturationParameters) -> Result<(), Fault> {
        self.attempts = self.attempts + Count(1);
        if self.attempts >= parameters.attempts {
            return Err(Fault::NotMoving);
        }
        self.resting = Some(Millisecond::ZERO);
        Ok(())
    }

    /// True while a stalled hitch rests; time passes.
    pub fn is_resting(&mut self, parameters: &SaturationParameters) -> bool {
        self.resting = self
            .resting
            .map(Millisecond::next)
            .filter(|&rested| rested <= parameters.retry_time);
        self.resting.is_some()
    }

    /// True while a stalled hitch rests.
    #[must_use]
    pub const fn rests(&self) -> bool {
        self.resting.is_some()
    }

    /// The lever was moved, or a fault was dealt with: all attempts are forgotten.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// True at the end of a window in which less than an eighth of the demanded travel was seen.
    fn compare(
        &mut self,
        direction: Direction,
        motion: &Motion,
        parameters: &SaturationParameters,
    ) -> bool {
        let mut window = self.window.unwrap_or(Window {
            start: motion.position(),
            demanded_nm: 0,
            age: Millisecond::ZERO,
        });
        window.age = window.age.next();
        let model = direction.sign(motion.model_speed().0);
        window.demanded_nm = window.demanded_nm.saturating_add(model);
        self.window = Some(window);
        if window.age < parameters.window {
            return false;
        }
        self.window = None;
        let demanded = Micrometre(window.demanded_nm.saturating_abs() / 1000);
        let moved = Micrometre(direction.sign((motion.position() - window.start).0));
        let stuck = demanded >= parameters.demanded_travel && moved < Micrometre(demanded.0 / 8);
        if !stuck && demanded >= parameters.demanded_travel {
            self.attempts = Count::ZERO;
        }
        stuck
    }
}
