//! Ride damping as the envelope sees it. Control claims a step for it; what is claimed has to keep to travel band, ground
//! speed and lever, by the raw inputs.
//!
//! The band lies about the place where the hitch was when the first step was claimed. That place stays through pauses, so
//! that new claims do not carry the hitch away; a current that is not claimed, or the lever, begins another one.

use hitch_quantities::calibration::design_parameters::SafetyParameters;
use hitch_quantities::calibration::field_parameters::RideParameters;
use hitch_quantities::units::{MilliAmp, MilliDegree, MillimetrePerSecond, Millisecond};
use hitch_quantities::{CoilCurrents, Inputs};

use crate::locks::Lock;

/// Movement of the lever from its place that ends damping: twice that of control, which sees it first.
const LEVER_MOVED: MilliDegree = MilliDegree(1_500);

/// The view.
#[derive(Clone, Copy, Debug, Default)]
pub struct RideWatch {
    /// The last step was claimed.
    claimed: bool,
    /// Angle and lever at the first claim.
    place: Option<[MilliDegree; 2]>,
    speed: Option<MillimetrePerSecond>,
    age: Millisecond,
}

impl RideWatch {
    /// One step. `claims`: its command is one of ride damping; `passed`: the currents of the last step. True if those were
    /// claimed and must not be.
    pub fn judge(
        &mut self,
        inputs: &Inputs,
        passed: CoilCurrents,
        claims: bool,
        lock: Lock,
        (ride, safety): (&RideParameters, &SafetyParameters),
    ) -> bool {
        self.receive(inputs.ground_speed, ride.time_out);
        let was_claimed = core::mem::replace(&mut self.claimed, claims);
        let flows = passed != CoilCurrents::OFF;
        let is_slow = self.speed.is_none_or(|speed| speed < ride.end_speed);
        let has_moved = self.lever_has_moved(inputs.lever);
        let is_operated =
            has_moved || lock != Lock::Open || inputs.jog.is_some() || inputs.set_point.is_some();
        let limit = ride.band + safety.limit_margin;
        let is_wrong =
            ride.fitted.0 == 0 || is_slow || is_operated || self.leaves(inputs, passed, limit);
        let begins_anew = !claims && (has_moved || flows && !was_claimed);
        let here = inputs
            .rocker_angle
            .zip(inputs.lever)
            .map(|(angle, lever)| [angle, lever]);
        self.place = match self.place {
            _ if begins_anew => None,
            None if claims => here,
            place => place,
        };
        was_claimed && flows && is_wrong
    }

    fn receive(&mut self, speed: Option<MillimetrePerSecond>, time_out: Millisecond) {
        self.age = self.age.counted_while(speed.is_none());
        self.speed = speed.or(self.speed).filter(|_| self.age <= time_out);
    }

    fn lever_has_moved(&self, lever: Option<MilliDegree>) -> bool {
        let moved = self
            .place
            .zip(lever)
            .map(|([_, from], lever)| (lever - from).magnitude());
        moved.is_some_and(|moved| moved > LEVER_MOVED)
    }

    /// True if a current drives the hitch further than the limit from its place.
    fn leaves(&self, inputs: &Inputs, passed: CoilCurrents, limit: MilliDegree) -> bool {
        let off = self
            .place
            .zip(inputs.rocker_angle)
            .map(|([from, _], angle)| angle - from);
        off.is_some_and(|off| {
            passed.lift > MilliAmp::ZERO && off > limit
                || passed.lower > MilliAmp::ZERO && off < -limit
        })
    }
}
