//! One millisecond of control: from inputs to the currents that are asked for.
//!
//! What becomes of them is the business of others. [`Control`] is told: what the envelope let pass
//! ([`Control::passed`]), that it objects ([`Control::fail`]), that the hitch has landed ([`Control::land`]).

use hitch_quantities::piston::{flow, piston_speed};
use hitch_quantities::units::{
    MicroLitrePerSecond, Micrometre, MicrometrePerSecond, MilliAmp, MilliDegree,
    MilliDegreePerSecond,
};
use hitch_quantities::{CoilCurrents, Fault, Inputs, ValidCalibration};

use crate::adaptation::learning::Learning;
use crate::commissioning::teach::{Taught, Teach, TeachError};
use crate::estimation::load::LoadEstimate;
use crate::estimation::motion::{Motion, Slack};
use crate::estimation::rest::RestPosition;
use crate::motion::position::{PositionControl, Reason};
use crate::motion::rate::RateControl;
use crate::operator::lever::SteadyLever;
use crate::operator::mode::Mode;
use crate::operator::{ButtonGuard, EngineWatch, Float, QuickLift, lowering_limit, upper_limit};
use crate::sensing::sensors::{Sensed, Sensors};
use crate::sequencing::saturation::{SaturationWatch, goes_no_further};
use crate::sequencing::sink::SinkWatch;
use crate::valve::closing::Closing;
use crate::valve::drop_scale::DropScale;
use crate::valve::phase::{Demand, Direction, Phase};
use crate::valve::valve_map::ValveCurves;

mod report;

/// What a step of control asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Request {
    /// Currents of the coils.
    pub currents: CoilCurrents,
    /// A fault is over: what the envelope has tripped on may be forgotten before it judges this step.
    pub recovered: bool,
}

/// The control part of the controller: a calibration and a state.
#[derive(Clone, Debug)]
pub struct Control {
    calibration: ValidCalibration,
    sensors: Sensors,
    mode: Mode,
    engine: EngineWatch,
    button: ButtonGuard,
    quick_lift: QuickLift,
    float: Float,
    lever: SteadyLever,
    position: PositionControl,
    rate: RateControl,
    motion: Motion,
    closing: Closing,
    slack: Slack,
    /// Set point and its travel: looked up when it changes.
    target: (MilliDegree, Micrometre),
    load: LoadEstimate,
    phase: Phase,
    sink: SinkWatch,
    saturation: SaturationWatch,
    /// A fault ended in this step.
    recovered: bool,
    /// Last believable angle.
    angle: MilliDegree,
    rest: RestPosition,
    scale: DropScale,
    learning: Learning,
    teach: Teach,
    /// Fastest speed that the valve in use can give.
    available: MicrometrePerSecond,
    /// Flow asked of the valves, positive into the cylinder.
    demanded_flow: MicroLitrePerSecond,
    // The largest comes last, so that the others are close to the controller's address.
    curves: ValveCurves,
}

impl Control {
    /// Control as it is after power-up: locked; `engine`: what it has told so far. Inlined where the whole controller is
    /// made: a copy would take its place on the stack.
    #[must_use]
    #[inline]
    pub fn new(calibration: ValidCalibration, engine: EngineWatch) -> Self {
        let load = LoadEstimate::new(&calibration.hydraulics);
        let mut curves = ValveCurves::EMPTY;
        curves.fill(&calibration);
        let scale = curves.scale(load.drop());
        let closing = Closing::of(&calibration);
        let origin = calibration.linkage.travel(MilliDegree::ZERO);
        Self {
            calibration,
            sensors: Sensors::default(),
            mode: Mode::default(),
            engine,
            button: ButtonGuard::default(),
            quick_lift: QuickLift::default(),
            float: Float::default(),
            lever: SteadyLever::default(),
            position: PositionControl::default(),
            rate: RateControl::default(),
            motion: Motion::default(),
            closing,
            slack: Slack::default(),
            target: (MilliDegree::ZERO, origin),
            load,
            phase: Phase::default(),
            sink: SinkWatch::default(),
            saturation: SaturationWatch::default(),
            recovered: false,
            angle: MilliDegree::ZERO,
            rest: RestPosition::default(),
            curves,
            scale,
            learning: Learning::default(),
            teach: Teach::default(),
            available: MicrometrePerSecond::ZERO,
            demanded_flow: MicroLitrePerSecond::ZERO,
        }
    }

    /// The calibration in use.
    #[must_use]
    pub fn calibration(&self) -> &ValidCalibration {
        &self.calibration
    }

    /// What the engine has told so far.
    #[must_use]
    pub const fn engine(&self) -> EngineWatch {
        self.engine
    }

    /// True while the machine is being taught: currents rise slowly from below any threshold.
    #[must_use]
    pub const fn teaches(&self) -> bool {
        matches!(self.mode, Mode::Teach)
    }

    /// Takes another calibration of the same machine: one whose ramps, gains or limits differ. The hitch may be moving,
    /// and goes on from where it is. What was learnt of the valves' curves goes with the curves.
    pub fn recalibrate(&mut self, calibration: ValidCalibration) {
        self.closing = Closing::of(&calibration);
        let measured_at = |calibration: &ValidCalibration| calibration.hydraulics.reference_drop;
        if (&calibration.lift, &calibration.lower)
            != (&self.calibration.lift, &self.calibration.lower)
        {
            self.learning.forget_curves();
            self.curves.fill(&calibration);
        } else if measured_at(&calibration) != measured_at(&self.calibration) {
            self.curves.fill(&calibration);
        }
        self.calibration = calibration;
    }

    /// What teaching found, if the machine has been taught since power-up.
    #[must_use]
    pub const fn taught(&self) -> Option<Result<Taught, TeachError>> {
        self.teach.result()
    }

    /// One step of 1 ms. `held_back`: the envelope let less pass than was asked for in the last one.
    pub fn step(&mut self, inputs: &Inputs, held_back: bool) -> Request {
        self.recovered = false;
        let sensed = self.sensors.judge(inputs, &self.calibration.sensors);
        let currents = match sensed.and_then(|sensed| self.run(&sensed, inputs, held_back)) {
            Ok(currents) => currents,
            Err(fault) => self.fail(fault),
        };
        self.angle = sensed.map(|sensed| sensed.angle).unwrap_or_default();
        Request {
            currents,
            recovered: self.recovered,
        }
    }

    /// Takes in the currents that are regulated in this step.
    pub fn passed(&mut self, currents: CoilCurrents) {
        // A button's speed falls with the linkage and stays: what the map gets wrong there does as well.
        let slowing = self.slack.is_taken() && matches!(self.mode, Mode::Position);
        self.motion.drive(
            self.learning.offsets().on_curve(currents),
            slowing,
            self.scale,
            &self.calibration,
        );
    }

    /// The hitch stands still and may lie on the ground: it stays where it is.
    pub fn land(&mut self) {
        self.stop_where_it_is();
        self.position.accept();
    }

    /// A fault: both coils off at once.
    pub fn fail(&mut self, fault: Fault) -> CoilCurrents {
        if matches!(self.mode, Mode::Teach) {
            self.teach.abort();
        }
        self.mode = Mode::failed(fault);
        self.button.distrust();
        self.demanded_flow = MicroLitrePerSecond::ZERO;
        self.phase = self.phase.cut();
        CoilCurrents::OFF
    }

    /// A step with believable sensors.
    fn run(
        &mut self,
        sensed: &Sensed,
        inputs: &Inputs,
        held_back: bool,
    ) -> Result<CoilCurrents, Fault> {
        self.estimate(sensed);
        let jog = self.button.pass(inputs.jog);
        self.change_mode(jog.is_some(), inputs);
        if matches!(self.mode, Mode::Teach) {
            return Ok(self.teach.step(sensed.angle, self.scale, &self.calibration));
        }
        let demand = match &mut self.mode {
            Mode::Locked(lock) => {
                if lock.picked_up(sensed.set_point, sensed.angle, &self.calibration.lock) {
                    self.mode = Mode::Position;
                }
                None
            }
            Mode::Position => self.follow_lever(sensed, inputs),
            // A released button has no demand: the abort ramp stops the hitch, faster than the button's own.
            Mode::Jog => jog.map(|rate| self.follow_button(rate, sensed.angle, inputs)),
            Mode::Hold | Mode::Teach | Mode::TransportLock | Mode::Fault { .. } => None,
        };
        self.advance(demand, held_back)?;
        self.watch_saturation(sensed)?;
        Ok(self.currents())
    }

    /// Motion, load and the place of rest, from the sensors and the last currents.
    fn estimate(&mut self, sensed: &Sensed) {
        let calibration = &self.calibration;
        let measured = calibration.linkage.travel(sensed.angle);
        self.motion
            .update(measured, self.phase, &calibration.motion);
        self.motion
            .follow_trail(measured, self.phase, &calibration.motion);
        self.load.update(
            sensed.cylinder_pressure,
            self.phase,
            &self.motion,
            &calibration.hydraulics,
        );
        self.scale = self.curves.scale(self.load.drop());
        self.rest
            .update(self.motion.position(), self.phase, &calibration.hold);
        self.sink.tick(&calibration.hold);
        self.learn();
    }

    /// Learns from where the hitch is on its way from rest to rest.
    fn learn(&mut self) {
        let Some(course) = self.learning.follow(self.phase, &self.motion) else {
            return;
        };
        let calibration = &self.calibration;
        let rest = self.rest.position();
        let told = course.told(rest, self.scale, calibration.hydraulics.piston_area);
        let of_offset = self.learning.offsets().blamed(&told);
        if self
            .motion
            .learn_lag(&told, of_offset, rest, &calibration.motion)
        {
            self.learning.learn(&told);
        }
    }

    /// Mode transitions that don't depend on the lever.
    fn change_mode(&mut self, jog_requested: bool, inputs: &Inputs) {
        let taught = matches!(self.mode, Mode::Teach);
        let engine = self
            .engine
            .permits(inputs.engine_speed, &self.calibration.lock);
        self.mode = self.mode.switched(inputs.switches, engine);
        let was_fault = self.mode.fault().is_some();
        self.mode = self.mode.healthy(&self.calibration.lock);
        if was_fault && self.mode.fault().is_none() {
            self.recovered = true;
            self.saturation.forget();
            self.sink.new_set_point();
        }
        // A released button ramps down before the lock falls shut.
        let jogged = jog_requested || self.phase.is_moving();
        let in_jog = matches!(self.mode, Mode::Jog);
        self.mode = self.mode.jogged(
            if in_jog { jogged } else { jog_requested },
            inputs.switches.teach && !self.phase.is_moving(),
        );
        match (taught, matches!(self.mode, Mode::Teach)) {
            (false, true) => self.teach = Teach::default(),
            (true, false) => self.teach.abort(),
            _ => {}
        }
        if jog_requested && !in_jog {
            self.rate = RateControl::default();
            self.position = PositionControl::default();
        }
        let follows_lever = matches!(self.mode, Mode::Position);
        self.quick_lift
            .press(inputs.switches.quick_lift, follows_lever);
        if !follows_lever {
            self.float.end();
        }
    }

    /// Jog mode: the demand that follows from the button. The dials bind it as they bind the lever.
    fn follow_button(
        &mut self,
        rate: MilliDegreePerSecond,
        angle: MilliDegree,
        inputs: &Inputs,
    ) -> Demand {
        let calibration = &self.calibration;
        let highest = upper_limit(inputs.upper_limit, &calibration.position);
        let demand = self
            .rate
            .demand(rate, angle, highest, &self.motion, calibration);
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

    /// Position mode: the demand that follows from the lever.
    fn follow_lever(&mut self, sensed: &Sensed, inputs: &Inputs) -> Option<Demand> {
        let moving = self.phase.is_moving();
        let calibration = &self.calibration;
        let trembles = calibration.position.lever_deadband;
        let lever = self.lever.follow(sensed.set_point, trembles + trembles);
        let lever = self.quick_lift.set_point(lever, &calibration.operator);
        let highest = upper_limit(inputs.upper_limit, &calibration.position);
        let changed = self
            .position
            .follow(lever, highest, moving, &calibration.position);
        if changed && !moving {
            self.sink.new_set_point();
            self.saturation.forget();
        }
        let set_point = self.position.set_point(sensed.angle);
        if set_point != self.target.0 {
            self.target = (set_point, calibration.linkage.travel(set_point));
        }
        let target = self.target.1;
        // While the valves close the hitch may fly past the set point: that is no arrival.
        let rest = self.rest.position();
        let resting = matches!(self.phase, Phase::Holding)
            && match self
                .position
                .reason_to_move(target, rest, &calibration.position)
            {
                Some(Reason::SetPoint) => false,
                Some(Reason::Drift) => self.learning.hurries(rest - target, &mut self.motion),
                None => true,
            };
        let operator = &calibration.operator;
        let floats = self.float.update(lever, sensed.angle, resting, operator);
        // Until the valves are shut nobody asks for a demand.
        if floats || resting || matches!(self.phase, Phase::Settling { .. }) {
            return None;
        }
        let parameters = &calibration.position;
        let lower_speed = lowering_limit(inputs.lowering_dial, operator, parameters);
        let demand = self.position.demand(
            target,
            self.phase,
            &self.motion,
            &self.closing,
            self.scale,
            calibration,
        );
        Some(self.position.paced(demand, lower_speed, parameters))
    }

    /// The next phase; starting a move forgets the last one's bias, and counts it if nobody asked for it.
    fn advance(&mut self, demand: Option<Demand>, held_back: bool) -> Result<(), Fault> {
        let calibration = &self.calibration;
        if self.mode.is_still() {
            self.phase = self.phase.cut();
        }
        let resting = self.saturation.is_resting(&calibration.saturation);
        let demand = demand.filter(|_| !resting);
        // A move that is called off ends on its own valve.
        let direction = match self.phase {
            Phase::Moving { direction, .. } => Some(direction),
            _ => demand.map(|demand| demand.direction),
        };
        self.available = direction.map_or(MicrometrePerSecond::ZERO, |direction| {
            self.available(direction)
        });
        let still = self.motion.model_speed() == MicrometrePerSecond::ZERO;
        let next = self.phase.step(
            demand,
            self.available,
            still,
            &calibration.position,
            &calibration.hold,
        );
        let next = match held_back {
            true => next.no_faster_than(self.phase),
            false => next,
        };
        if next.is_moving() && !self.phase.is_moving() {
            self.motion.forget_bias();
            self.begin(next)?;
        }
        if self.phase.is_moving() && !next.is_moving() {
            self.motion.cut(&self.closing, &self.calibration);
        }
        self.phase = next;
        let follows_lever = matches!(self.mode, Mode::Position);
        if next.is_moving() && follows_lever && self.position.has_arrived() {
            let speed = self.motion.model_speed();
            self.sink.correcting(speed, &self.calibration.hold)?;
        }
        Ok(())
    }

    /// A move begins: counts it if nobody asked for it. Only moves to a set point teach: a leak has a part in corrections.
    fn begin(&mut self, next: Phase) -> Result<(), Fault> {
        self.learning.obstruct();
        let Phase::Moving { direction, .. } = next else {
            return Ok(());
        };
        if !matches!(self.mode, Mode::Position) {
            return Ok(());
        }
        match self.position.start() {
            Reason::SetPoint => {
                self.motion.count_late();
                self.learning.begin(direction, self.rest.position());
            }
            Reason::Drift => self.sink.correct(&self.calibration.hold)?,
        }
        Ok(())
    }

    /// Cuts the coil when flow is demanded and nothing moves.
    fn watch_saturation(&mut self, sensed: &Sensed) -> Result<(), Fault> {
        let calibration = &self.calibration;
        let (phase, pump) = (self.phase, sensed.pump_pressure);
        if !self.saturation.stalled(
            phase,
            &self.motion,
            pump,
            &calibration.saturation,
            &calibration.hydraulics,
        ) {
            return Ok(());
        }
        self.stop_where_it_is();
        let lifts = phase.speed() > MicrometrePerSecond::ZERO;
        if goes_no_further(lifts, sensed, &self.calibration) {
            self.position.accept();
            return Ok(());
        }
        self.saturation.rest(&self.calibration.saturation)
    }

    /// Cuts the coil of a hitch that stands still: nothing is learnt of this move.
    fn stop_where_it_is(&mut self) {
        self.phase = self.phase.cut();
        self.learning.obstruct();
        self.motion.obstruct();
    }

    /// Fastest speed that the valve of a direction can give now.
    fn available(&self, direction: Direction) -> MicrometrePerSecond {
        let map = self.curves.at(self.scale);
        let flow = match direction {
            Direction::Lift => map.lift_saturation(),
            Direction::Lower => map.lower_saturation(),
        };
        piston_speed(flow, self.calibration.hydraulics.piston_area)
    }

    /// Speed along the way that the map is asked for: the ramped one less what the map gets wrong.
    fn mapped_speed(&self) -> MicrometrePerSecond {
        let Phase::Moving { direction, speed } = self.phase else {
            return MicrometrePerSecond::ZERO;
        };
        let excess = MicrometrePerSecond(direction.sign(self.motion.bias().0));
        let further = match self.mode {
            Mode::Jog => -self.rate.trim(),
            _ => self.motion.damping(direction),
        };
        // Full demand is a fully open valve, whatever it gives; from there on the correction comes in with the ramp.
        let excess = match excess > MicrometrePerSecond::ZERO {
            true => excess.min((self.available - speed).max(MicrometrePerSecond::ZERO)),
            false => excess,
        };
        let wanted = (speed - excess + further).limited(MicrometrePerSecond(1), self.available);
        MicrometrePerSecond(direction.sign(wanted.0))
    }

    /// Coil currents of the present phase.
    fn currents(&mut self) -> CoilCurrents {
        let flow = flow(self.mapped_speed(), self.calibration.hydraulics.piston_area);
        self.demanded_flow = flow;
        let (speed, hydraulics) = (self.phase.speed(), &self.calibration.hydraulics);
        let slack = self.slack.take_up(speed.magnitude(), hydraulics.hysteresis);
        let map = self.curves.at(self.scale);
        let offsets = self.learning.offsets();
        let with = |current: MilliAmp, offset| (current - slack + offset).max(MilliAmp::ZERO);
        // No flow is no current, whatever the valve.
        let mut currents = CoilCurrents::OFF;
        if flow.0 > 0 {
            currents.lift = with(map.lift_current(flow), offsets.lift());
        } else if flow.0 < 0 {
            currents.lower = with(map.lower_current(-flow), offsets.lower());
        }
        currents
    }
}

#[cfg(feature = "damage")]
impl Control {
    /// Flips a bit of the calibration in use, as failing memory does.
    pub fn flip(&mut self, word: usize, bit: u32) {
        self.calibration.flip(word, bit);
    }
}
