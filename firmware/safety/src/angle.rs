//! Watches the angle: one sensor, and what it must do while a coil moves the hitch.

use hitch_quantities::calibration::design_parameters::{SafetyParameters, SensorParameters};
use hitch_quantities::units::{MilliAmp, MilliDegree, Millisecond};
use hitch_quantities::{CoilCurrents, Inputs};

use super::following::{AngleReading, FollowingMonitor, Standstill};
use super::noise_detector::NoiseDetector;
use super::samples::{SPAN, Samples};
use crate::limits::Limits;

/// The noise measure averages over this many samples: noise of +-0.8 degree is found in 18 ms, and that of a sensor
/// with 0.1 degree, one sigma, is seven of its own sigmas below the limit.
const NOISE_SAMPLES: i32 = 16;

/// What is wrong with the angle in this step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AngleFaults {
    /// Missing or out of range.
    pub missing: bool,
    /// Further from the last good sample than the hitch can move.
    pub jumps: bool,
    /// The same to the last bit although travel is required.
    pub frozen: bool,
    /// Noisier than the sensor.
    pub noisy: bool,
    /// Shows less travel than required.
    pub not_following: bool,
    /// Moves against the energised coil.
    pub against: bool,
}

/// The watch.
#[derive(Clone, Copy, Debug, Default)]
pub struct AngleWatch {
    /// The last good samples; `None` before the first.
    samples: Option<Samples>,
    bad_for: Millisecond,
    /// The last sample in range, and the step to it.
    last: MilliDegree,
    step: MilliDegree,
    /// Whether the sensor shows noise at rest, and how long its sample has been the same.
    noise: NoiseDetector,
    /// Mean magnitude of the second difference, times [`NOISE_SAMPLES`].
    noise_sum: i32,
    /// Piston travel, upwards, that a sensor with lag has yet to show, by the valve curves, nm.
    hidden_nm: i32,
    /// Since the coil was switched on.
    stroke: Option<Stroke>,
    /// A hitch that was lowered stands still, and the command has not been off since.
    ground_contact: bool,
}

/// Motion since a coil was switched on.
#[derive(Clone, Copy, Debug)]
struct Stroke {
    /// Angle along the coil's way where it was switched on.
    first: MilliDegree,
    /// Furthest such angle.
    furthest: MilliDegree,
    /// How far the sensor may go back, as it still shows an earlier motion.
    settling: MilliDegree,
    /// Travel required and seen.
    following: FollowingMonitor,
}

impl AngleWatch {
    /// One step with the inputs and the currents that were passed in the last one. `slow_start`: currents rise slowly
    /// from below any threshold.
    pub fn judge(
        &mut self,
        inputs: &Inputs,
        passed: CoilCurrents,
        slow_start: bool,
        limits: Limits<'_>,
    ) -> AngleFaults {
        let sensors = limits.sensors;
        let in_range = inputs
            .rocker_angle
            .filter(|angle| sensors.angle_min <= *angle && *angle <= sensors.angle_max);
        let believed = in_range.filter(|&angle| !self.jumps_to(angle, sensors));
        let mut faults = AngleFaults {
            missing: in_range.is_none(),
            jumps: in_range.is_some() && believed.is_none(),
            ..AngleFaults::default()
        };
        if let Some(angle) = in_range {
            let at_rest = passed == CoilCurrents::OFF;
            faults.noisy = self.judge_noise(angle, at_rest, limits.safety);
        }
        // Noise of a bad signal isn't the sensor's.
        if faults != AngleFaults::default() {
            self.noise.reset();
        }
        faults.frozen = self.noise.is_noisy() && self.noise.same_for() >= limits.safety.still_time;
        match believed {
            Some(angle) => {
                self.bad_for = Millisecond::ZERO;
                match &mut self.samples {
                    Some(samples) => samples.take(angle),
                    None => self.samples = Some(Samples::of(angle)),
                }
            }
            None => self.bad_for = self.bad_for.next(),
        }
        self.judge_motion(believed, inputs, passed, slow_start, limits, &mut faults);
        faults
    }

    /// True while the lowering coil is cut, because the hitch may be on the ground.
    pub const fn has_ground_contact(&self) -> bool {
        self.ground_contact
    }

    /// Current limit of a stroke until motion has been detected.
    pub fn onset_limit(&self, slow_start: bool, limits: Limits<'_>) -> Option<CoilCurrents> {
        self.stroke
            .map_or(FollowingMonitor::default(), |stroke| stroke.following)
            .onset_limit(slow_start, limits)
    }

    /// The command without a lowering current if the hitch may be on the ground; a command without one ends that.
    pub fn withhold(&mut self, command: CoilCurrents) -> CoilCurrents {
        self.ground_contact &= command.lower > MilliAmp::ZERO;
        if self.ground_contact {
            CoilCurrents::OFF
        } else {
            command
        }
    }

    /// After a gap that has been a fault, any angle will do.
    fn jumps_to(&self, angle: MilliDegree, sensors: &SensorParameters) -> bool {
        self.bad_for <= sensors.bridged
            && self
                .samples
                .as_ref()
                .is_some_and(|samples| (angle - samples.newest()).magnitude() > sensors.angle_jump)
    }

    /// What the sensor shows.
    fn shown(&self, samples: &Samples) -> AngleReading {
        AngleReading {
            mean: samples.mean(SPAN),
            latest: samples.mean(SPAN / 2),
            noise: MilliDegree(self.noise_sum / NOISE_SAMPLES),
        }
    }

    /// What a sample in range says by its last bits, whether it is believed or not; true if it is too noisy.
    fn judge_noise(
        &mut self,
        angle: MilliDegree,
        at_rest: bool,
        safety: &SafetyParameters,
    ) -> bool {
        if self.samples.is_none() {
            self.last = angle;
        }
        let step = angle - self.last;
        self.last = angle;
        self.noise.update(step, at_rest);
        // A single jump is no noise: it counts for no more than twice the limit.
        let most = safety.noise_limit + safety.noise_limit;
        let bend = (step - self.step).magnitude().min(most).0;
        self.step = step;
        let mean = self.noise_sum / NOISE_SAMPLES;
        self.noise_sum = self.noise_sum.saturating_add(bend).saturating_sub(mean);
        mean > safety.noise_limit.0
    }

    /// Checks the effect of an energised coil on the angle. The required travel remains while no sample is valid. Before the
    /// first good sample no current is passed, so there is nothing to check.
    fn judge_motion(
        &mut self,
        believed: Option<MilliDegree>,
        inputs: &Inputs,
        passed: CoilCurrents,
        slow_start: bool,
        limits: Limits<'_>,
        faults: &mut AngleFaults,
    ) {
        self.follow_hidden(passed, limits);
        let lifting = passed.lift > MilliAmp::ZERO;
        let energised = lifting || passed.lower > MilliAmp::ZERO;
        let Some(samples) = self.samples.as_ref().filter(|_| energised) else {
            self.stroke = None;
            return;
        };
        let shown = self.shown(samples);
        let along = |angle: MilliDegree| if lifting { angle } else { -angle };
        let newest = along(samples.newest());
        let settling = settling(self.hidden_nm, lifting, shown.mean, limits);
        let stroke = self.stroke.get_or_insert(Stroke {
            first: newest,
            furthest: newest,
            settling,
            following: FollowingMonitor::default(),
        });
        if believed.is_some() {
            stroke.furthest = stroke.furthest.max(newest);
            let most = limits.safety.contradiction;
            let back = stroke.furthest - newest > most + stroke.settling;
            // A hitch that was lowered far and comes up again has bounced off the ground: nothing is swapped.
            let bounced = back && !lifting && stroke.furthest - stroke.first > most;
            self.ground_contact |= bounced;
            faults.against = back && !bounced;
        }
        let safety = limits.safety;
        let stands = stroke
            .following
            .judge(shown, passed, slow_start, inputs, limits);
        let fault = stands == Some(Standstill::Fault);
        let same = self.noise.same_for() >= safety.frozen_time;
        faults.frozen |= fault && same;
        faults.not_following = fault && !same;
        self.ground_contact |= stands == Some(Standstill::GroundContact);
    }

    /// The part of the travel that a sensor with lag has yet to show.
    fn follow_hidden(&mut self, passed: CoilCurrents, limits: Limits<'_>) {
        let given = limits.machine.signed_speed(passed).0;
        let lag = limits.sensors.angle_lag.divisor();
        self.hidden_nm = self.hidden_nm.saturating_add(given);
        self.hidden_nm = self.hidden_nm.saturating_sub(lag.divide(self.hidden_nm));
    }
}

/// How far a sensor with lag may go against a coil that is switched on now: twice what it has yet to show of a motion
/// the other way. A heavy load sinks by 1.3 times the curve's speed, and a spool that closes 40 ms late leaves 1.5 times
/// of it at 0.1 s of lag, less at a longer one.
fn settling(hidden_nm: i32, lifting: bool, angle: MilliDegree, limits: Limits<'_>) -> MilliDegree {
    let against = if lifting {
        hidden_nm.saturating_neg()
    } else {
        hidden_nm
    };
    let micrometre = against.max(0) / 1_000;
    MilliDegree(micrometre.saturating_mul(limits.machine.degrees(angle)) / 1_000 * 2)
}
