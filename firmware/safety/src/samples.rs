//! The last good samples of the angle.

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::MilliDegree;

/// Samples whose mean is compared with the required travel: noise of 0.1 degree is then 0.025 degree.
pub const SPAN: usize = 16;

/// The last [`SPAN`] good samples, at least one of them taken.
#[derive(Clone, Copy, Debug)]
pub struct Samples {
    values: [MilliDegree; SPAN],
    /// Index of the newest.
    newest: usize,
}

impl Samples {
    /// The first sample, in place of those before it.
    pub const fn of(angle: MilliDegree) -> Self {
        Self {
            values: [angle; SPAN],
            newest: 0,
        }
    }

    /// Takes in a new one, in place of the oldest.
    pub fn take(&mut self, angle: MilliDegree) {
        self.newest = self.newest.wrapping_add(1) % SPAN;
        self.values[self.newest] = angle;
    }

    /// The newest.
    pub fn newest(&self) -> MilliDegree {
        let at = self.newest % SPAN;
        self.values.get(at).copied().unwrap_or_default()
    }

    /// Mean of the latest `samples`, at most [`SPAN`].
    pub fn mean(&self, samples: usize) -> MilliDegree {
        let sum = (0..samples).fold(0_i32, |sum, steps| {
            let at = self.newest.wrapping_sub(steps) % SPAN;
            sum.saturating_add(self.values.get(at).map_or(0, |sample| sample.0))
        });
        MilliDegree(Divisor::at_least_one(samples as i32).divide(sum))
    }
}
