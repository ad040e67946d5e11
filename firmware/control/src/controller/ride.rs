//! Ride damping in the step: when it may act, and its currents.

use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::piston::flow;
use hitch_quantities::units::{
    MicroLitrePerSecond, MicrometrePerSecond, MilliAmp, MilliDegree, PerMille,
};
use hitch_quantities::{CoilCurrents, Inputs, Reason};

use super::Control;
use crate::operator::lowering_limit;
use crate::ride::{RideDamping, Situation};
use crate::sensing::sensors::Sensed;
use crate::valve::phase::Phase;

impl Control {
    /// One step at the set point of the position law. True if ride damping acts, and the position law does not.
    ///
    /// It begins with the hitch at rest at its set point, and ends with a new one (`changed`). Where it ends the hitch
    /// returns to the set point by a move, not by a correction of drift.
    pub(super) fn rides(
        &mut self,
        sensed: &Sensed,
        inputs: &Inputs,
        highest: MilliDegree,
        changed: bool,
    ) -> bool {
        if !RideDamping::is_fitted(&self.calibration) {
            return false;
        }
        let rides = self.ride.demand().is_some();
        let is_at_rest = matches!(self.phase, Phase::Holding) && self.position.has_arrived();
        let is_lever = inputs.set_point.is_none()
            && matches!(self.reference.reason(), None | Some(Reason::AboveGround));
        let calibration = &self.calibration;
        let situation = Situation {
            is_free: !changed && is_lever && (rides || is_at_rest),
            set_point: self.target.0,
            target: self.target.1,
            highest,
            lowering: lowering_limit(
                inputs.lowering_dial,
                &calibration.operator,
                &calibration.position,
            ),
            travel: calibration.linkage.travel(sensed.angle),
        };
        self.ride.step(&situation, calibration);
        let now = self.ride.demand().is_some();
        match (rides, now) {
            (false, true) => {
                self.adaptation.discard_move();
                self.motion.discard_move();
            }
            (true, false) if !changed => self.position.begin_anew(),
            _ => {}
        }
        now
    }

    /// Coil currents of a demanded piston speed.
    pub(super) fn ride_currents(&mut self, speed: MicrometrePerSecond) -> CoilCurrents {
        let flow = flow(speed, self.calibration.hydraulics.piston_area);
        self.demanded_flow = flow;
        let mapped = match flow {
            MicroLitrePerSecond::ZERO => None,
            flow => self.valve_map(flow),
        };
        let settled = self.coil_currents(mapped);
        let [lift, lower] = self.motion.spools();
        let forcing = self.calibration.ride.forcing;
        CoilCurrents {
            lift: forced(settled.lift, lift, forcing),
            lower: forced(settled.lower, lower, forcing),
        }
    }
}

/// Current that brings a spool to its place sooner: above the settled current by a multiple of what the spool lacks. A spool
/// that starts from its closed end first has to pass its dead zone, which takes it longer than a quarter of a swing.
fn forced(settled: MilliAmp, spool: MilliAmp, forcing: PerMille) -> MilliAmp {
    if settled == MilliAmp::ZERO {
        return settled;
    }
    let lacks = settled - spool;
    let more = MilliAmp(mul_div(lacks.0, forcing.0, Divisor::THOUSAND));
    (settled + more).max(MilliAmp(1))
}
