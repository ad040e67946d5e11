//! One millisecond of control: from inputs to the requested currents.
//!
//! ```text
//! inputs -> sensors -> observer, adaptation -> modes -> feedback law -> requested currents
//! ```
//!
//! The feedback law is in `law.rs`, the mode transitions are in `modes.rs`, observer and adaptation in `adaptation.rs`,
//! stall and drift monitoring in `monitoring.rs`, and the outputs in `report.rs`.
//!
//! The caller reports what happens to the request: the regulated currents ([`Control::set_regulated_currents`]), a trip
//! of the envelope ([`Control::fail`]), and ground contact ([`Control::accept_ground_contact`]).

use hitch_quantities::units::{
    MicroLitrePerSecond, Micrometre, MicrometrePerSecond, MilliDegree, Millisecond,
};
use hitch_quantities::{CoilCurrents, Fault, Inputs, ValidCalibration};

use crate::adaptation::valve_adaptation::ValveAdaptation;
use crate::commissioning::teach::{Taught, Teach, TeachError};
use crate::estimation::hysteresis_compensation::HysteresisCompensation;
use crate::estimation::load::LoadEstimate;
use crate::estimation::motion_observer::MotionObserver;
use crate::estimation::rest::RestPosition;
use crate::estimation::travel_distances::TravelDistances;
use crate::motion::position::PositionControl;
use crate::motion::rate::RateControl;
use crate::operator::button::ButtonGuard;
use crate::operator::engage::EngageSwitch;
use crate::operator::lever::SteadyLever;
use crate::operator::mode::Mode;
use crate::operator::{EngineWatch, Float, QuickLift};
use crate::reference::ReferenceControl;
use crate::reference::in_work::InWork;
use crate::ride::RideDamping;
use crate::sensing::sensors::{Sensed, Sensors};
use crate::sequencing::drift_monitor::DriftMonitor;
use crate::sequencing::stall_detector::StallDetector;
use crate::valve::closing::ClosingCurves;
use crate::valve::drop_scale::DropScale;
use crate::valve::phase::Phase;
use crate::valve::valve_map::ValveCurves;

mod adaptation;
mod law;
mod modes;
mod monitoring;
mod report;
mod ride;
mod work;

/// Output of a control step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ControlRequest {
    /// Requested currents of the coils.
    pub currents: CoilCurrents,
    /// A fault has ended: lever or button have to be touched anew.
    pub recovered: bool,
    /// There is no fault: control asks for the end of a trip of the envelope.
    pub healthy: bool,
    /// The currents are those of ride damping.
    pub rides: bool,
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
    engage: EngageSwitch,
    float: Float,
    lever: SteadyLever,
    reference: ReferenceControl,
    ride: RideDamping,
    in_work: InWork,
    /// Time until a move of this step is in work.
    until_work: Option<Millisecond>,
    position: PositionControl,
    rate: RateControl,
    motion: MotionObserver,
    closing: ClosingCurves,
    distances: TravelDistances,
    hysteresis: HysteresisCompensation,
    /// Set point and its piston travel, which is looked up when the set point changes.
    target: (MilliDegree, Micrometre),
    load: LoadEstimate,
    phase: Phase,
    drift: DriftMonitor,
    stall: StallDetector,
    /// A fault ended in this step.
    recovered: bool,
    /// Last valid angle.
    angle: MilliDegree,
    rest: RestPosition,
    scale: DropScale,
    adaptation: ValveAdaptation,
    teach: Teach,
    /// Saturation speed of the active valve.
    available: MicrometrePerSecond,
    /// Demanded flow, positive into the cylinder.
    demanded_flow: MicroLitrePerSecond,
    // The largest comes last, so that the others are close to the controller's address.
    curves: ValveCurves,
}

impl Control {
    /// Control after power-up: locked. `engine`: state of the engine monitor. Inlined where the whole controller is
    /// made: a copy would need its size on the stack.
    #[must_use]
    #[inline]
    pub fn new(calibration: ValidCalibration, engine: EngineWatch) -> Self {
        let load = LoadEstimate::new(&calibration.hydraulics);
        let mut curves = ValveCurves::EMPTY;
        curves.fill(&calibration);
        let scale = curves.scale(load.drop());
        let closing = ClosingCurves::of(&calibration);
        let distances = TravelDistances::of(&calibration.linkage);
        let origin = calibration.linkage.travel(MilliDegree::ZERO);
        Self {
            calibration,
            sensors: Sensors::default(),
            mode: Mode::default(),
            engine,
            button: ButtonGuard::default(),
            quick_lift: QuickLift::default(),
            engage: EngageSwitch::default(),
            float: Float::default(),
            lever: SteadyLever::default(),
            reference: ReferenceControl::default(),
            ride: RideDamping::default(),
            in_work: InWork::default(),
            until_work: None,
            position: PositionControl::default(),
            rate: RateControl::default(),
            motion: MotionObserver::default(),
            closing,
            distances,
            hysteresis: HysteresisCompensation::default(),
            target: (MilliDegree::ZERO, origin),
            load,
            phase: Phase::default(),
            drift: DriftMonitor::default(),
            stall: StallDetector::default(),
            recovered: false,
            angle: MilliDegree::ZERO,
            rest: RestPosition::default(),
            curves,
            scale,
            adaptation: ValveAdaptation::default(),
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

    /// State of the engine monitor.
    #[must_use]
    pub const fn engine(&self) -> EngineWatch {
        self.engine
    }

    /// Takes another calibration of the same machine, with other ramps or gains. The hitch may be moving. If
    /// the valve curves differ, their adaptation is reset.
    pub fn recalibrate(&mut self, calibration: ValidCalibration) {
        self.closing = ClosingCurves::of(&calibration);
        self.distances = TravelDistances::of(&calibration.linkage);
        let measured_at = |calibration: &ValidCalibration| calibration.hydraulics.reference_drop;
        if (&calibration.lift, &calibration.lower)
            != (&self.calibration.lift, &self.calibration.lower)
        {
            self.adaptation.reset_for_new_curves();
            self.curves.fill(&calibration);
        } else if measured_at(&calibration) != measured_at(&self.calibration) {
            self.curves.fill(&calibration);
        }
        self.calibration = calibration;
    }

    /// Result of teaching, if the machine has been taught since power-up.
    #[must_use]
    pub const fn taught(&self) -> Option<Result<Taught, TeachError>> {
        self.teach.result()
    }

    /// One step of 1 ms. `held_back`: the envelope has limited the request of the last step.
    pub fn step(&mut self, inputs: &Inputs, held_back: bool) -> ControlRequest {
        self.recovered = false;
        if ReferenceControl::is_fitted(&self.calibration) {
            let moves = self.phase.is_moving();
            self.reference.sense(inputs, moves, &self.calibration);
        }
        let sensed = self.sensors.judge(inputs, &self.calibration.sensors);
        let offset = self.calibration.hydraulics.pressure_offset;
        let sensed = sensed.map(|sensed| sensed.without_offset(offset));
        let angle = sensed.map(|sensed| sensed.angle).ok();
        self.in_work
            .step(angle, self.reference.in_soil(), &self.calibration.work);
        self.until_work = None;
        if RideDamping::is_fitted(&self.calibration) {
            let pressure = sensed.ok().and_then(|sensed| sensed.cylinder_pressure);
            self.ride.sense(inputs, pressure, &self.calibration.ride);
        }
        let currents = match sensed.and_then(|sensed| self.run(&sensed, inputs, held_back)) {
            Ok(currents) => currents,
            Err(fault) => self.fail(fault),
        };
        self.angle = sensed.map(|sensed| sensed.angle).unwrap_or_default();
        ControlRequest {
            currents,
            recovered: self.recovered,
            healthy: self.mode.fault().is_none(),
            rides: self.ride.demand().is_some(),
        }
    }

    /// A step with valid sensors.
    fn run(
        &mut self,
        sensed: &Sensed,
        inputs: &Inputs,
        held_back: bool,
    ) -> Result<CoilCurrents, Fault> {
        self.observe(sensed);
        let teaches = matches!(self.mode, Mode::Teach);
        let jog = self
            .button
            .pass(inputs, sensed.angle, teaches, &self.calibration);
        self.update_mode(jog.is_some(), inputs);
        if matches!(self.mode, Mode::Teach) {
            return Ok(self.teach.step(sensed.angle, self.scale, &self.calibration));
        }
        self.feedback_law(sensed, inputs, jog, held_back)
    }
}

#[cfg(feature = "damage")]
impl Control {
    /// Flips a bit of the calibration in use, as a memory fault does.
    pub fn flip_calibration_bit(&mut self, word: usize, bit: u32) {
        self.calibration.flip(word, bit);
    }
}
