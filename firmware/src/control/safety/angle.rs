//! Watches the angle: one sensor, and what it must do while a coil moves the hitch.

use core::cmp::Ordering;

use super::super::design_parameters::{SafetyParameters, SensorParameters};
use super::super::units::{MilliAmp, MilliDegree, MilliDegreePerSecond, Millisecond};
use super::CoilCurrents;

/// Samples over which the speed is measured: noise of 0.05 degree is then 4 degrees a second.
const SPAN: usize = 16;
/// From the difference between the ends of [`SPAN`] samples to a second: 1000 / 15, half a percent too large.
const TO_SPEED: i32 = 67;
/// A sensor trembles if its steps at rest have gone to and fro for so many points, and is sure to at most this.
const TREMBLES: i32 = 100;
const MOST_TREMBLE: i32 = 1_000;
/// Points of a step to and fro by more than the converter's digit, of a step onwards, and of a sample like the last one.
/// With these points the sum grows only where white noise has a sigma of more than a digit. A sensor with less of it may
/// tremble where it is near a step of the converter, between one digit and the next, and stand still half a digit on.
const TO_AND_FRO: i32 = 4;
const ONWARDS: i32 = -2;
const STANDING: i32 = -2;
/// The digit is the smallest of the latest steps: what is known of it grows by a sixteenth a step.
const FORGETS: i32 = 16;
/// The noise measure averages over this many samples.
const NOISE_SAMPLES: i32 = 32;

/// What is wrong with the angle in this step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AngleFaults {
    /// Missing or out of range.
    pub missing: bool,
    /// Further from the last good sample than the hitch can move.
    pub jumps: bool,
    /// The same to the last bit although the hitch was moving.
    pub frozen: bool,
    /// Noisier than the sensor.
    pub noisy: bool,
    /// Was moving and seems to have stopped, at an unchanged current.
    pub not_following: bool,
    /// Moves against the energised coil.
    pub against: bool,
}

/// The watch.
#[derive(Clone, Copy, Debug)]
pub struct AngleWatch {
    /// The last good samples, the newest at `newest`.
    samples: [MilliDegree; SPAN],
    newest: usize,
    /// Any of them.
    filled: bool,
    bad_for: Millisecond,
    /// The last sample in range, the step to it, and which way it last went.
    last: MilliDegree,
    step: MilliDegree,
    way: Ordering,
    /// How long the sample has been the same, and the speed before.
    same_for: Millisecond,
    speed_before: MilliDegreePerSecond,
    /// The current at that time.
    current_before: MilliAmp,
    /// The smallest of the latest steps: the converter's digit.
    digit: MilliDegree,
    /// Points that a resting sensor has for trembling.
    tremble: i32,
    /// Mean magnitude of the second difference, times [`NOISE_SAMPLES`].
    noise_sum: i32,
    /// Since the coil was switched on.
    stroke: Option<Stroke>,
}

/// Motion since a coil was switched on.
#[derive(Clone, Copy, Debug)]
struct Stroke {
    /// Furthest angle along the coil's way.
    furthest: MilliDegree,
    /// Fastest speed along it, and the current that gave it.
    fastest: MilliDegreePerSecond,
    current: MilliAmp,
    /// Since the current was reduced; until the hitch has followed, no speed is fast.
    settling: Millisecond,
}

impl Default for AngleWatch {
    fn default() -> Self {
        Self {
            samples: [MilliDegree::ZERO; SPAN],
            newest: 0,
            filled: false,
            bad_for: Millisecond::ZERO,
            last: MilliDegree::ZERO,
            step: MilliDegree::ZERO,
            way: Ordering::Equal,
            same_for: Millisecond::ZERO,
            speed_before: MilliDegreePerSecond::ZERO,
            current_before: MilliAmp::ZERO,
            digit: MilliDegree::ZERO,
            tremble: 0,
            noise_sum: 0,
            stroke: None,
        }
    }
}

impl AngleWatch {
    /// One step with the sample and the currents that were passed in the last one.
    pub fn judge(
        &mut self,
        sample: Option<MilliDegree>,
        passed: CoilCurrents,
        sensors: &SensorParameters,
        safety: &SafetyParameters,
    ) -> AngleFaults {
        let in_range =
            sample.filter(|angle| sensors.angle_min <= *angle && *angle <= sensors.angle_max);
        let believed = in_range.filter(|&angle| !self.jumps_to(angle, sensors));
        let mut faults = AngleFaults {
            missing: in_range.is_none(),
            jumps: in_range.is_some() && believed.is_none(),
            ..AngleFaults::default()
        };
        if let Some(angle) = in_range {
            self.judge_noise(angle, passed, safety, &mut faults);
        }
        match believed {
            Some(angle) => {
                self.bad_for = Millisecond::ZERO;
                self.take(angle);
                self.judge_motion(angle, passed, safety, &mut faults);
            }
            None => self.bad_for = self.bad_for.next(),
        }
        faults
    }

    /// After a gap that has been a fault, any angle will do.
    fn jumps_to(&self, angle: MilliDegree, sensors: &SensorParameters) -> bool {
        self.bad_for <= sensors.bridged
            && self.filled
            && (angle - self.back(0)).magnitude() > sensors.angle_jump
    }

    /// The sample `steps` before the newest.
    fn back(&self, steps: usize) -> MilliDegree {
        let at = self.newest.wrapping_sub(steps) % SPAN;
        self.samples.get(at).copied().unwrap_or_default()
    }

    /// What a sample in range says by its last bits, whether it is believed or not.
    fn judge_noise(
        &mut self,
        angle: MilliDegree,
        passed: CoilCurrents,
        safety: &SafetyParameters,
        faults: &mut AngleFaults,
    ) {
        if !self.filled {
            self.last = angle;
        }
        let step = angle - self.last;
        self.last = angle;
        match step.cmp(&MilliDegree::ZERO) {
            Ordering::Equal => self.same_for = self.same_for.next(),
            way => {
                if passed == CoilCurrents::OFF {
                    let moved = match way == self.way {
                        true => ONWARDS,
                        false if self.spans_digits(step) => TO_AND_FRO,
                        false => 0,
                    };
                    // Standing is counted once it is over: a sensor that never moves again is what is looked for.
                    let stood = self.same_for.0.saturating_mul(STANDING);
                    let change = moved.saturating_add(stood);
                    self.tremble = self.tremble.saturating_add(change).clamp(0, MOST_TREMBLE);
                }
                self.way = way;
                let grown = self.digit.0.saturating_add(self.digit.0 / FORGETS + 1);
                self.digit = MilliDegree(grown).min(step.magnitude());
                self.same_for = Millisecond::ZERO;
                self.speed_before = self.speed();
                self.current_before = passed.lift + passed.lower;
            }
        }
        // A single jump is no noise: it counts for no more than twice the limit.
        let most = safety.noise_limit + safety.noise_limit;
        let bend = (step - self.step).magnitude().min(most).0;
        self.step = step;
        let mean = self.noise_sum / NOISE_SAMPLES;
        self.noise_sum = self.noise_sum.saturating_add(bend).saturating_sub(mean);
        faults.noisy = mean > safety.noise_limit.0;
        faults.frozen = self.tremble >= TREMBLES && self.same_for >= safety.still_time;
    }

    /// Whether a step is larger than from one digit to the next.
    fn spans_digits(&self, step: MilliDegree) -> bool {
        step.magnitude().0.saturating_mul(2) > self.digit.0.saturating_mul(3)
    }

    /// Takes in a good sample.
    fn take(&mut self, angle: MilliDegree) {
        if !self.filled {
            self.samples = [angle; SPAN];
        }
        self.newest = self.newest.wrapping_add(1) % SPAN;
        self.samples[self.newest] = angle;
        self.filled = true;
    }

    /// Speed over the last samples.
    fn speed(&self) -> MilliDegreePerSecond {
        let oldest = self.back(SPAN - 1);
        MilliDegreePerSecond((self.back(0) - oldest).0.saturating_mul(TO_SPEED))
    }

    fn judge_motion(
        &mut self,
        angle: MilliDegree,
        passed: CoilCurrents,
        safety: &SafetyParameters,
        faults: &mut AngleFaults,
    ) {
        let lifting = passed.lift > MilliAmp::ZERO;
        if !lifting && passed.lower <= MilliAmp::ZERO {
            self.stroke = None;
            // A hitch that has been let go may stop as it likes.
            self.speed_before = MilliDegreePerSecond::ZERO;
            return;
        }
        // What the hitch should have moved since the sample froze.
        let owed = self
            .speed_before
            .magnitude()
            .0
            .saturating_mul(self.same_for.0);
        let unchanged = self.current_before - (passed.lift + passed.lower)
            <= MilliAmp(safety.unchanged_current.0 / 2);
        faults.frozen |= unchanged
            && self.speed_before.magnitude() >= safety.frozen_speed
            && self.same_for >= safety.frozen_time
            && owed >= safety.frozen_travel.0.saturating_mul(1000);
        let speed = self.speed();
        let (along, speed, current) = match lifting {
            true => (angle, speed, passed.lift),
            false => (-angle, -speed, passed.lower),
        };
        let stroke = self.stroke.get_or_insert(Stroke {
            furthest: along,
            fastest: speed,
            current,
            settling: safety.following_time,
        });
        stroke.furthest = stroke.furthest.max(along);
        faults.against = stroke.furthest - along > safety.contradiction;
        faults.not_following = stroke.stands_still(speed, current, safety);
    }
}

impl Stroke {
    /// One step; true if the hitch was moving and, at an unchanged current, has all but stopped.
    fn stands_still(
        &mut self,
        speed: MilliDegreePerSecond,
        current: MilliAmp,
        safety: &SafetyParameters,
    ) -> bool {
        if self.current - current > safety.unchanged_current {
            self.settling = Millisecond::ZERO;
        }
        if self.settling < safety.following_time {
            self.settling = self.settling.next();
            self.current = current;
            self.fastest = speed;
            return false;
        }
        self.current = self.current.max(current);
        self.fastest = self.fastest.max(speed);
        self.fastest >= safety.telling_speed && speed.0 < self.fastest.0 / 8
    }
}
