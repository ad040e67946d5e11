//! Noise of the angle sensor, for display in a tool only: no coil depends on it.
//!
//! The second difference of samples with white noise of variance `s^2` has the variance `(1 + 4 + 1) s^2`. The
//! acceleration of a moving hitch adds 0.0005 degree at 500 deg/s2. The mean square is an integer, with a resolution of
//! 0.0004 degree. Only its root is in floating point.

use hitch_quantities::units::MilliDegree;
use micromath::F32;

/// Averaging length, samples: the result has a standard deviation of 5 % for white noise.
const SAMPLES: u32 = 1_024;
/// Limit of a second difference, mdeg, because a single jump is not noise. The sum of squares then fits a word.
const MOST: u32 = 2_000;
/// Ratio of the variances of the second difference and of a sample.
const OF_BEND: f32 = 6.0;
/// Millidegrees in a degree.
const MILLIDEGREES: f32 = 1_000.0;

/// Noise estimator.
#[derive(Clone, Copy, Debug, Default)]
pub struct AngleNoise {
    last: Option<MilliDegree>,
    /// Difference of the last two samples.
    step: Option<MilliDegree>,
    sum_of_squares: u32,
}

impl AngleNoise {
    /// Adds one sample; after a missing one the differences restart.
    pub fn update(&mut self, angle: Option<MilliDegree>) {
        let step = angle.zip(self.last).map(|(angle, last)| angle - last);
        if let Some((step, before)) = step.zip(self.step) {
            let bend = (step - before).0.unsigned_abs().min(MOST);
            let mean = self.sum_of_squares / SAMPLES;
            let square = bend.wrapping_mul(bend);
            self.sum_of_squares = self
                .sum_of_squares
                .saturating_sub(mean)
                .saturating_add(square);
        }
        self.last = angle;
        self.step = step;
    }

    /// Sum of squared second differences over 1 024 samples, mdeg2.
    #[must_use]
    pub const fn sum_of_squares(&self) -> u32 {
        self.sum_of_squares
    }
}

/// Root of the mean square of a sample's noise, degrees, from [`AngleNoise::sum_of_squares`]: within 0.2 %. The bits of
/// a number in single precision. Not inlined: `cargo xtask stack` allows floating point in this function alone.
#[must_use]
#[inline(never)]
pub fn rms_deg_bits(sum_of_squares: u32) -> u32 {
    rms_deg(sum_of_squares).to_bits()
}

fn rms_deg(sum_of_squares: u32) -> f32 {
    if sum_of_squares == 0 {
        return 0.0;
    }
    let variance = sum_of_squares as f32 / (SAMPLES as f32 * OF_BEND * MILLIDEGREES * MILLIDEGREES);
    let rough = F32(variance).sqrt().0;
    // The root of micromath is up to 6 % too large; a Newton step squares this error.
    0.5 * (rough + variance / rough)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The root in double precision.
    fn exact_deg(sum_of_squares: u32) -> f64 {
        (f64::from(sum_of_squares) / 1_024.0 / 6.0).sqrt() * 1e-3
    }

    #[test]
    fn the_root_is_within_a_fifth_of_a_percent_and_none_of_nothing() {
        assert_eq!(rms_deg(0), 0.0);
        let most = SAMPLES * MOST * MOST;
        let mut sums: std::vec::Vec<u32> = (1..100_000).collect();
        sums.extend((100_000..=u32::MAX).step_by(9_973));
        sums.extend([most, u32::MAX]);
        let errors = sums.into_iter().map(|sum| {
            let error = f64::from(rms_deg(sum)) / exact_deg(sum) - 1.0;
            assert!(error.abs() <= 0.002, "{sum}: {error}");
            error.abs()
        });
        let worst = errors.fold(0.0, f64::max);
        std::println!("worst {worst:.6}");
        assert!(worst > 0.001, "the bound is not what it could be: {worst}");
    }

    #[test]
    fn white_noise_is_told_at_rest_and_on_the_way() {
        let mut random = fastrand::Rng::with_seed(1);
        for speed in [0, 60] {
            for sigma in [2.0, 20.0, 100.0] {
                let mut noise = AngleNoise::default();
                let mut sum_deg = 0.0;
                for step in 0..20_000 {
                    let uniform: f64 = (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
                    let angle = speed * step + (sigma * uniform).round() as i32;
                    noise.update(Some(MilliDegree(angle)));
                    if step >= 10_000 {
                        sum_deg += f64::from(rms_deg(noise.sum_of_squares()));
                    }
                }
                let found = sum_deg / 10_000.0 * 1e3;
                // Rounding to millidegrees adds variance.
                let truth = f64::sqrt(sigma * sigma + 1.0 / 12.0);
                assert!(
                    (found / truth - 1.0).abs() < 0.05,
                    "{found}, not {truth} mdeg"
                );
            }
        }
    }

    #[test]
    fn gaps_and_jumps_are_no_noise() {
        let mut noise = AngleNoise::default();
        for step in 0..10_000 {
            let angle = (step % 3 > 0).then_some(MilliDegree(step % 2 * 50_000));
            noise.update(angle);
        }
        assert_eq!(
            noise.sum_of_squares(),
            0,
            "two samples in a row bend nothing"
        );
        for angle in [i32::MAX, i32::MIN, i32::MIN, i32::MAX, 0]
            .into_iter()
            .cycle()
            .take(5_000)
        {
            noise.update(Some(MilliDegree(angle)));
        }
        assert!(noise.sum_of_squares() <= SAMPLES * (MOST * MOST + 1));
    }
}
