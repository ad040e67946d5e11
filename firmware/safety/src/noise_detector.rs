//! Detects noise of the angle sensor at rest. A noisy sensor whose sample stays the same for long is frozen.
//!
//! White noise of more than a converter step changes most samples, with frequent reversals. A sensor with less noise
//! shows noise only near a transition of the converter, so an unchanged sample is no evidence.

use core::cmp::Ordering;
use hitch_quantities::units::{MilliDegree, Millisecond};

/// Points from which a sensor is noisy, and their upper limit.
const NOISY_POINTS: i32 = 100;
const MAX_POINTS: i32 = 1_000;
/// Points of a reversal by more than a converter step, of a change in the same direction, and of an unchanged sample.
/// The sum only grows if white noise has a sigma of more than a converter step.
const REVERSAL_POINTS: i32 = 4;
const CONTINUATION_POINTS: i32 = -2;
const UNCHANGED_POINTS: i32 = -2;
/// The converter step is the smallest recent change; the estimate grows by a sixteenth with each change.
const STEP_MEMORY: i32 = 16;

/// Noise of the sensor.
#[derive(Clone, Copy, Debug)]
pub struct NoiseDetector {
    /// Direction of the last change.
    direction: Ordering,
    /// Time for which the sample has been unchanged.
    same_for: Millisecond,
    /// Estimated converter step: the smallest recent change.
    converter_step: MilliDegree,
    /// Points for noise at rest.
    points: i32,
}

impl Default for NoiseDetector {
    fn default() -> Self {
        Self {
            direction: Ordering::Equal,
            same_for: Millisecond::ZERO,
            converter_step: MilliDegree::ZERO,
            points: 0,
        }
    }
}

impl NoiseDetector {
    /// One step: how far the sample is from the last one, and whether both coils were off.
    pub fn update(&mut self, change: MilliDegree, at_rest: bool) {
        let direction = change.cmp(&MilliDegree::ZERO);
        if direction == Ordering::Equal {
            self.same_for = self.same_for.next();
            return;
        }
        if at_rest {
            let moved = match direction == self.direction {
                true => CONTINUATION_POINTS,
                false if self.exceeds_converter_step(change) => REVERSAL_POINTS,
                false => 0,
            };
            // An unchanged period counts once it has ended: a frozen sensor never ends it.
            let unchanged = self.same_for.0.saturating_mul(UNCHANGED_POINTS);
            let points = moved.saturating_add(unchanged);
            self.points = self.points.saturating_add(points).clamp(0, MAX_POINTS);
        }
        self.direction = direction;
        let grown = self
            .converter_step
            .0
            .saturating_add(self.converter_step.0 / STEP_MEMORY + 1);
        self.converter_step = MilliDegree(grown).min(change.magnitude());
        self.same_for = Millisecond::ZERO;
    }

    /// Resets the points.
    pub fn reset(&mut self) {
        self.points = 0;
    }

    /// Time for which the sample has been unchanged.
    pub const fn same_for(&self) -> Millisecond {
        self.same_for
    }

    /// True if the sensor has shown noise that changes most samples.
    pub const fn is_noisy(&self) -> bool {
        self.points >= NOISY_POINTS
    }

    /// Whether a change is larger than one converter step.
    fn exceeds_converter_step(&self, change: MilliDegree) -> bool {
        change.magnitude().0.saturating_mul(2) > self.converter_step.0.saturating_mul(3)
    }
}
