//! The feedback law of one step.
//!
//! ```text
//! reference -> position or rate law -> speed ramp -> speed law -> flow -> valve map -> current
//! ```

use hitch_quantities::piston::{flow, piston_speed};
use hitch_quantities::units::{
    MicroLitrePerSecond, Micrometre, MicrometrePerSecond, MilliAmp, MilliDegree,
    MilliDegreePerSecond,
};
use hitch_quantities::{CoilCurrents, Fault, Inputs};

use super::Control;
use crate::motion::position::MoveReason;
use crate::operator::engage::Engagement;
use crate::operator::mode::Mode;
use crate::operator::{lowering_limit, upper_limit};
use crate::reference::{ReferenceControl, Situation};
use crate::sensing::sensors::Sensed;
use crate::valve::phase::{Demand, Direction, Phase};

/// Reference of the law that is active in the present mode.
#[derive(Clone, Copy, Debug)]
enum Reference {
    /// Piston travel, of the position law.
    Position(Micrometre),
    /// Rate of the rocker, of the rate law.
    Rate(MilliDegreePerSecond),
}

impl Control {
    /// The feedback law. `jog`: the requested rate while a button is held.
    pub(super) fn feedback_law(
        &mut self,
        sensed: &Sensed,
        inputs: &Inputs,
        jog: Option<MilliDegreePerSecond>,
        held_back: bool,
    ) -> Result<CoilCurrents, Fault> {
        let reference = self.reference(sensed, inputs, jog);
        if let Some(speed) = self.ride.demand() {
            return Ok(self.ride_currents(speed));
        }
        let demand = reference.map(|reference| match reference {
            Reference::Position(target) => self.position_law(target, inputs),
            Reference::Rate(rate) => self.rate_law(rate, sensed, inputs),
        });
        self.speed_ramp(demand, held_back)?;
        self.check_stall(sensed)?;
        let speed = self.speed_law();
        let flow = flow(speed, self.calibration.hydraulics.piston_area);
        self.demanded_flow = flow;
        let current = self.valve_map(flow);
        Ok(self.coil_currents(current))
    }

    /// The reference of the present mode. `None`: no motion is demanded.
    fn reference(
        &mut self,
        sensed: &Sensed,
        inputs: &Inputs,
        jog: Option<MilliDegreePerSecond>,
    ) -> Option<Reference> {
        match &mut self.mode {
            Mode::Locked(lock) => {
                if lock.picked_up(sensed.set_point, sensed.angle, &self.calibration.lock) {
                    self.mode = Mode::Position;
                }
                None
            }
            Mode::Position => self
                .position_reference(sensed, inputs)
                .map(Reference::Position),
            // After release of the button there is no reference: the abort ramp, which is steeper, stops the hitch.
            Mode::Jog => jog.map(Reference::Rate),
            Mode::Hold | Mode::Teach | Mode::TransportLock | Mode::Fault { .. } => None,
        }
    }

    /// Position mode: the target that follows from lever, quick lift and dials. `None` at the target, while the hitch
    /// floats, and until the valves are closed.
    fn position_reference(&mut self, sensed: &Sensed, inputs: &Inputs) -> Option<Micrometre> {
        let moving = self.phase.is_moving();
        let calibration = &self.calibration;
        let noise_band = self.position.bands(&calibration.position).lever_deadband;
        let lever = self.lever.follow(sensed.set_point, noise_band + noise_band);
        let engagement = self.engagement(lever, inputs);
        let calibration = &self.calibration;
        let lever = self.quick_lift.set_point(lever, &calibration.operator);
        let highest = upper_limit(inputs.upper_limit, &calibration.position);
        let aim = self.field_reference((lever, engagement), highest, sensed, inputs);
        let calibration = &self.calibration;
        let changed = self
            .position
            .follow(aim, highest, moving, &calibration.position);
        if changed && !moving {
            self.drift.reset();
            self.stall.reset();
        }
        let set_point = self.position.set_point(sensed.angle);
        if set_point != self.target.0 {
            self.target = (set_point, calibration.linkage.travel(set_point));
        }
        let target = self.target.1;
        if self.rides(sensed, inputs, highest, changed) {
            return None;
        }
        let resting = matches!(self.phase, Phase::Holding) && self.stays(target);
        let calibration = &self.calibration;
        let floats = self
            .float
            .update(lever, sensed.angle, resting, &calibration.operator);
        if floats || resting || matches!(self.phase, Phase::Settling { .. }) {
            return None;
        }
        Some(target)
    }

    /// The switch of quick engagement in position mode. It takes the hitch from quick lift, whose next press takes it back.
    fn engagement(&mut self, lever: MilliDegree, inputs: &Inputs) -> Engagement {
        let is_raised = self.quick_lift.is_raised();
        let is_held = self.reference.engages();
        if inputs.set_point.is_some() || is_raised && is_held {
            self.engage.end();
            return Engagement::Off;
        }
        let pressed = inputs.switches.engage;
        let engagement = self.engage.step(pressed, lever, &self.calibration.lock);
        if engagement == Engagement::Begins {
            self.quick_lift.lower();
        }
        engagement
    }

    /// The set point that draft, slip and quick engagement make of the lever; the lever on a machine without draft pins, and
    /// while an implement or quick lift is in command.
    fn field_reference(
        &mut self,
        (lever, engagement): (MilliDegree, Engagement),
        highest: MilliDegree,
        sensed: &Sensed,
        inputs: &Inputs,
    ) -> MilliDegree {
        let engages = engagement != Engagement::Off || self.reference.engages();
        if !ReferenceControl::is_fitted(&self.calibration) && !engages {
            return lever;
        }
        if inputs.set_point.is_some() || self.quick_lift.is_raised() {
            self.reference.end();
            return lever;
        }
        let (operator, position) = (&self.calibration.operator, &self.calibration.position);
        let lowering = lowering_limit(inputs.lowering_dial, operator, position);
        let valve_speeds = [
            self.saturation_speed(Direction::Lift)
                .min(position.lift_speed),
            self.saturation_speed(Direction::Lower).min(lowering),
        ];
        let situation = Situation {
            lever,
            engagement,
            angle: sensed.angle,
            highest,
            valve_speeds,
        };
        self.reference.step(inputs, &situation, &self.calibration)
    }

    /// True if a hitch that holds has no reason to move, or if that has yet to be known.
    ///
    /// The hitch may pass the set point while the valves close: only a hitch at rest has arrived. Whether it is off its
    /// set point is known once the angle sensor has settled; a new set point needs no such wait.
    fn stays(&mut self, target: Micrometre) -> bool {
        if self.position.has_moved() && !self.angle_has_settled() {
            return true;
        }
        let rest = self.rest.position();
        match self
            .position
            .reason_to_move(target, rest, &self.calibration.position)
        {
            Some(MoveReason::SetPoint) => false,
            Some(MoveReason::Drift) => self.adaptation.finish_before_correction(
                rest - target,
                self.distances.overshoot,
                &mut self.motion,
            ),
            None => true,
        }
    }

    /// Position law: from the distance to the target to the demanded speed.
    fn position_law(&mut self, target: Micrometre, inputs: &Inputs) -> Demand {
        let calibration = &self.calibration;
        let parameters = &calibration.position;
        // An implement moves the hitch more slowly than the operator may.
        let most = match inputs.set_point {
            Some(_) => calibration.remote.speed,
            None => MicrometrePerSecond(i32::MAX),
        };
        let lower_speed = lowering_limit(inputs.lowering_dial, &calibration.operator, parameters);
        let lower_speed = lower_speed.min(most);
        self.until_work = self.time_until_work(target, lower_speed);
        let calibration = &self.calibration;
        let mut demand = self.position.demand(
            target,
            self.phase,
            &self.motion,
            &self.closing,
            self.scale,
            calibration,
        );
        if demand.direction == Direction::Lift {
            demand.speed = demand.speed.min(most);
        }
        self.position
            .limit_approach(demand, lower_speed, parameters)
    }

    /// Rate law: from the rate of the button to the demanded speed. The dials limit it as in position mode.
    fn rate_law(&mut self, rate: MilliDegreePerSecond, sensed: &Sensed, inputs: &Inputs) -> Demand {
        let calibration = &self.calibration;
        let highest = upper_limit(inputs.upper_limit, &calibration.position);
        let demand = self
            .rate
            .demand(rate, sensed.angle, highest, &self.motion, calibration);
        if demand.direction == Direction::Lift {
            return demand;
        }
        let limit = lowering_limit(
            inputs.lowering_dial,
            &calibration.operator,
            &calibration.position,
        );
        Demand {
            speed: demand.speed.min(limit),
            ..demand
        }
    }

    /// Speed ramp and check-valve sequence: the next phase. A move that begins or ends is reported to the observer and
    /// the monitors.
    fn speed_ramp(&mut self, demand: Option<Demand>, held_back: bool) -> Result<(), Fault> {
        let calibration = &self.calibration;
        if self.mode.is_still() {
            self.phase = self.phase.cut();
        }
        let waiting = self.stall.tick_retry_delay(&calibration.saturation);
        let demand = demand.filter(|_| !waiting);
        // A cancelled move ends on its own valve.
        let direction = match self.phase {
            Phase::Moving { direction, .. } => Some(direction),
            _ => demand.map(|demand| demand.direction),
        };
        self.available = direction.map_or(MicrometrePerSecond::ZERO, |direction| {
            self.saturation_speed(direction)
        });
        let still = self.motion.model_speed() == MicrometrePerSecond::ZERO;
        let next = self.phase.step(
            demand,
            self.available,
            still,
            &calibration.position,
            &calibration.hold,
        );
        let next = if held_back {
            next.limited_to_speed_of(self.phase)
        } else {
            next
        };
        if next.is_moving() && !self.phase.is_moving() {
            self.motion
                .begin_move(self.calibration.hydraulics.compensator_lag);
            self.begin_move(next)?;
        }
        if self.phase.is_moving() && !next.is_moving() {
            self.motion.record_cut(&self.closing, &self.calibration);
        }
        self.phase = next;
        self.check_drift()
    }

    /// Speed law: the ramped speed less the bias of the valve map, with damping (position mode) or integral trim (jog
    /// mode). Signed: positive lifts.
    fn speed_law(&self) -> MicrometrePerSecond {
        let Phase::Moving { direction, speed } = self.phase else {
            return MicrometrePerSecond::ZERO;
        };
        let bias = MicrometrePerSecond(direction.sign(self.motion.bias().0));
        let correction = match self.mode {
            Mode::Jog => -self.rate.trim(),
            _ => self.motion.damping(direction),
        };
        // At full demand the valve is fully open, whatever the bias. Below it the bias is limited to the margin.
        let bias = if bias > MicrometrePerSecond::ZERO {
            bias.min((self.available - speed).max(MicrometrePerSecond::ZERO))
        } else {
            bias
        };
        let speed = (speed - bias + correction).limited(MicrometrePerSecond(1), self.available);
        MicrometrePerSecond(direction.sign(speed.0))
    }

    /// Inverse valve map: the valve of the flow's direction and its current. `None` without flow.
    pub(super) fn valve_map(&self, flow: MicroLitrePerSecond) -> Option<(Direction, MilliAmp)> {
        let map = self.curves.at(self.scale);
        match flow.0 {
            0 => None,
            1.. => Some((Direction::Lift, map.lift_current(flow))),
            _ => Some((Direction::Lower, map.lower_current(-flow))),
        }
    }

    /// Coil currents: the mapped current with hysteresis compensation and threshold offset.
    pub(super) fn coil_currents(&mut self, mapped: Option<(Direction, MilliAmp)>) -> CoilCurrents {
        let compensation = self.hysteresis.step(
            self.phase.speed().magnitude(),
            self.calibration.hydraulics.hysteresis,
            self.distances.deceleration,
        );
        let offsets = self.adaptation.offsets();
        let corrected =
            |current: MilliAmp, offset| (current - compensation + offset).max(MilliAmp::ZERO);
        let mut currents = CoilCurrents::OFF;
        match mapped {
            Some((Direction::Lift, current)) => {
                currents.lift = corrected(current, offsets.lift());
            }
            Some((Direction::Lower, current)) => {
                currents.lower = corrected(current, offsets.lower());
            }
            None => {}
        }
        currents
    }

    /// Piston speed of the fully open valve of a direction.
    fn saturation_speed(&self, direction: Direction) -> MicrometrePerSecond {
        let map = self.curves.at(self.scale);
        let flow = match direction {
            Direction::Lift => map.lift_saturation(),
            Direction::Lower => map.lower_saturation(),
        };
        piston_speed(flow, self.calibration.hydraulics.piston_area)
    }
}
