//! Tells whether a resting angle sensor shows noise, so that the same sample for long means that it is frozen.
//!
//! White noise of more than a converter step changes most samples, and they go to and fro. A sensor with less noise may
//! show some of it near the edge between two steps and none half a step away: it proves nothing.

use core::cmp::Ordering;
use hitch_quantities::units::{MilliDegree, Millisecond};

/// Points from which a sensor counts as noisy, and the most that are counted.
const ENOUGH: i32 = 100;
const MOST: i32 = 1_000;
/// Points of a sample that goes back by more than a converter step, of one that goes on, and of one like the last.
/// With these the sum grows only where white noise has a sigma of more than a converter step.
const TO_AND_FRO: i32 = 4;
const ONWARDS: i32 = -2;
const STANDING: i32 = -2;
/// The converter step is the smallest of the latest changes: what is known of it grows by a sixteenth a change.
const FORGETS: i32 = 16;

/// What is known of the sensor's noise.
#[derive(Clone, Copy, Debug)]
pub struct Tremble {
    /// Which way the last change went.
    way: Ordering,
    /// How long the sample has been the same.
    same_for: Millisecond,
    /// The smallest of the latest changes: the converter step.
    digit: MilliDegree,
    /// Points for noise at rest.
    points: i32,
}

impl Default for Tremble {
    fn default() -> Self {
        Self {
            way: Ordering::Equal,
            same_for: Millisecond::ZERO,
            digit: MilliDegree::ZERO,
            points: 0,
        }
    }
}

impl Tremble {
    /// One step: how far the sample is from the last one, and whether both coils were off.
    pub fn update(&mut self, change: MilliDegree, at_rest: bool) {
        let way = change.cmp(&MilliDegree::ZERO);
        if way == Ordering::Equal {
            self.same_for = self.same_for.next();
            return;
        }
        if at_rest {
            let moved = match way == self.way {
                true => ONWARDS,
                false if self.spans_digits(change) => TO_AND_FRO,
                false => 0,
            };
            // Standing is counted once it is over: a sensor that never changes again is what is looked for.
            let stood = self.same_for.0.saturating_mul(STANDING);
            let points = moved.saturating_add(stood);
            self.points = self.points.saturating_add(points).clamp(0, MOST);
        }
        self.way = way;
        let grown = self.digit.0.saturating_add(self.digit.0 / FORGETS + 1);
        self.digit = MilliDegree(grown).min(change.magnitude());
        self.same_for = Millisecond::ZERO;
    }

    /// Forgets what was seen of noise.
    pub fn forget(&mut self) {
        self.points = 0;
    }

    /// How long the sample has been the same.
    pub const fn same_for(&self) -> Millisecond {
        self.same_for
    }

    /// True if the sensor has shown noise that changes most samples.
    pub const fn is_noisy(&self) -> bool {
        self.points >= ENOUGH
    }

    /// Whether a change is larger than one converter step.
    fn spans_digits(&self, change: MilliDegree) -> bool {
        change.magnitude().0.saturating_mul(2) > self.digit.0.saturating_mul(3)
    }
}
