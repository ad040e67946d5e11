//! Stall detector: flow is demanded and the hitch does not move.
//!
//! During a lift the flow equals the map only while the compensator has margin. At the relief pressure, at the end of
//! the stroke or against an obstacle, the pump flow passes the relief valve at 154 bar instead. The detector uses the
//! pump pressure, if there is a sensor, and always the comparison of demanded and measured travel. The demanded travel is
//! that which an angle sensor with lag would show. After a stall the
//! coil is cut, and there are a few more attempts, each after a delay. At the end of the stroke and on the ground the
//! hitch stays where it is until the lever is moved; this is no fault.

use hitch_quantities::calibration::design_parameters::{HydraulicParameters, SaturationParameters};
use hitch_quantities::units::{Count, Micrometre, MilliBar, MilliDegree, Millisecond};
use hitch_quantities::{Calibration, Fault};

use crate::estimation::motion_observer::MotionObserver;
use crate::sensing::sensors::Sensed;
use crate::valve::phase::{Direction, Phase};

/// A stall this close to a limit of the travel is at the end of travel: an end stop, or a wrong limit.
const END_ZONE: MilliDegree = MilliDegree(2_000);

/// True if a stalled hitch is at an end of its stroke or on the ground.
///
/// On the ground there is no pressure at an open lowering valve. Without a pressure sensor a lowering valve that does
/// not open is indistinguishable from that; the hitch then does not sink, which is safe.
#[must_use]
pub fn is_at_end_of_travel(lifts: bool, sensed: &Sensed, calibration: &Calibration) -> bool {
    let (position, hydraulics) = (&calibration.position, &calibration.hydraulics);
    let is_unloaded = || {
        let empty = |pressure| pressure <= hydraulics.smallest_drop;
        sensed.cylinder_pressure.is_none_or(empty)
    };
    if lifts {
        sensed.angle >= position.upper_limit - END_ZONE
    } else {
        sensed.angle <= position.lower_limit + END_ZONE || is_unloaded()
    }
}

/// Detects a stall.
#[derive(Clone, Copy, Debug, Default)]
pub struct StallDetector {
    window: Option<TravelWindow>,
    near_relief: Millisecond,
    attempts: Count,
    retry_delay: Option<Millisecond>,
}

/// One comparison of demanded and measured travel.
#[derive(Clone, Copy, Debug)]
struct TravelWindow {
    start: Micrometre,
    demanded_nm: i32,
    age: Millisecond,
}

impl StallDetector {
    /// One step; true when flow is demanded and nothing moves.
    pub fn is_stalled(
        &mut self,
        phase: Phase,
        motion: &MotionObserver,
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
        let is_near = full && direction == Direction::Lift;
        self.near_relief = self.near_relief.counted_while(is_near);
        self.compare(direction, motion, parameters) || self.near_relief >= parameters.relief_time
    }

    /// The hitch stalled before the end of travel: starts the delay before the next attempt.
    ///
    /// # Errors
    /// There were too many attempts.
    pub fn start_retry_delay(&mut self, parameters: &SaturationParameters) -> Result<(), Fault> {
        self.attempts = self.attempts + Count(1);
        if self.attempts >= parameters.attempts {
            return Err(Fault::NotMoving);
        }
        self.retry_delay = Some(Millisecond::ZERO);
        Ok(())
    }

    /// One step of the retry delay; true while it lasts.
    pub fn tick_retry_delay(&mut self, parameters: &SaturationParameters) -> bool {
        self.retry_delay = self
            .retry_delay
            .map(Millisecond::next)
            .filter(|&waited| waited <= parameters.retry_time);
        self.retry_delay.is_some()
    }

    /// True during the retry delay.
    #[must_use]
    pub const fn is_waiting(&self) -> bool {
        self.retry_delay.is_some()
    }

    /// The lever was moved or a fault has ended: resets the attempts.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// True at the end of a window in which less than an eighth of the demanded travel was seen.
    fn compare(
        &mut self,
        direction: Direction,
        motion: &MotionObserver,
        parameters: &SaturationParameters,
    ) -> bool {
        let model = direction.sign(motion.shown_model_speed().0);
        if model < 0 {
            // A sensor with lag still shows an earlier motion the other way.
            self.window = None;
            return false;
        }
        let mut window = self.window.unwrap_or(TravelWindow {
            start: motion.shown_position(),
            demanded_nm: 0,
            age: Millisecond::ZERO,
        });
        window.age = window.age.next();
        window.demanded_nm = window.demanded_nm.saturating_add(model);
        self.window = Some(window);
        if window.age < parameters.window {
            return false;
        }
        self.window = None;
        let demanded = Micrometre(window.demanded_nm / 1000);
        let moved = Micrometre(direction.sign((motion.shown_position() - window.start).0));
        let stalled = demanded >= parameters.demanded_travel && moved < Micrometre(demanded.0 / 8);
        if !stalled && demanded >= parameters.demanded_travel {
            self.attempts = Count::ZERO;
        }
        stalled
    }
}
