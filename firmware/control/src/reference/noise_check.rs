//! Noise of a sensor: the mean change from one sample to the next.
//!
//! A sensor whose contact is loose or whose ground is broken jumps from sample to sample, in a way that no motion and no soil does.

use hitch_quantities::units::MilliHertz;

use super::low_pass::LowPass;

/// Low-pass on the changes: ten times the noise of a healthy sensor is found in 25 ms.
const CORNER: MilliHertz = MilliHertz(3_200);

/// The check from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoiseCheck {
    last: Option<i32>,
    mean_change: LowPass,
}

impl NoiseCheck {
    /// One sample: whether the samples change by more than `limit` on average, both in the same unit.
    pub fn is_noisy(&mut self, sample: i32, limit: i32) -> bool {
        let change = sample.saturating_sub(self.last.unwrap_or(sample));
        self.last = Some(sample);
        self.mean_change.step(change.saturating_abs(), CORNER) > limit
    }
}
