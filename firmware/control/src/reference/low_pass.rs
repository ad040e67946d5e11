//! First-order low-pass: `y' = 2 pi f (x - y)`, in steps of a millisecond.

use hitch_quantities::fixed::mul_shift_16;
use hitch_quantities::units::MilliHertz;

/// Fraction bits of the output.
const BITS: u32 = 4;
/// Largest magnitude of a sample that its fraction bits leave room for.
const LARGEST: i32 = i32::MAX >> (BITS + 1);
/// `2 pi / 10^6` times 2^32: a share of 2^-16 from a frequency in millihertz, or from millihertz times milliseconds, in one
/// product.
pub const RADIAN: i32 = 26_986;

/// The filter, of any quantity; its first sample is its first output.
#[derive(Clone, Copy, Debug, Default)]
pub struct LowPass {
    fine: Option<i32>,
}

impl LowPass {
    /// One step. Magnitudes above 2^26 count as that.
    pub fn step(&mut self, sample: i32, corner: MilliHertz) -> i32 {
        let sample = sample.clamp(-LARGEST, LARGEST) << BITS;
        let before = self.fine.unwrap_or(sample);
        let share = mul_shift_16(corner.0, RADIAN).min(1 << 16);
        let after = before.saturating_add(mul_shift_16(sample.saturating_sub(before), share));
        self.fine = Some(after);
        after >> BITS
    }

    /// The present output; 0 before the first sample.
    #[must_use]
    pub fn output(&self) -> i32 {
        self.fine.unwrap_or(0) >> BITS
    }

    /// Forgets all samples.
    pub fn reset(&mut self) {
        *self = Self::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_has_gone_by_63_percent_after_the_time_constant() {
        for corner in [100, 500, 3_200] {
            let mut filter = LowPass::default();
            filter.step(0, MilliHertz(corner));
            let time_ms = 1e6 / (core::f64::consts::TAU * f64::from(corner));
            let steps = time_ms.round() as i32;
            let after = (0..steps).fold(0, |_, _| filter.step(20_000, MilliHertz(corner)));
            let exact = 20_000.0 * (1.0 - (-f64::from(steps) / time_ms).exp());
            let error = f64::from(after) - exact;
            assert!(error.abs() < 200.0, "{corner} mHz: {after}, not {exact}");
        }
    }

    #[test]
    fn extremes_stay_finite() {
        let mut filter = LowPass::default();
        for sample in [i32::MIN, i32::MAX, 0, -1, i32::MIN] {
            for corner in [i32::MIN, 0, 1, i32::MAX] {
                filter.step(sample, MilliHertz(corner));
            }
        }
    }
}
