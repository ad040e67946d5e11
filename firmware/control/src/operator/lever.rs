//! The lever without its noise.
//!
//! An untouched lever shows noise in the last digits of its converter. A plain low-pass filter would delay the
//! operator, so only changes within the noise band are filtered. A larger change moves the filter output along, and a
//! step is taken over at once:
//!
//! ```text
//! y' = (x - y) / T,    x - d <= y <= x + d        d: noise band
//! ```

use hitch_quantities::units::MilliDegree;

/// Averaged in units of 2^-5 millidegrees over so many bits of steps: 32 ms, less than the shortest move takes.
const BITS: u32 = 5;
/// Larger than any movement by hand in a millisecond: the lever was switched, or the filter was not active.
const STEP_LIMIT: MilliDegree = MilliDegree(1_000);

/// Lever filter.
#[derive(Clone, Copy, Debug, Default)]
pub struct SteadyLever {
    fine: i32,
}

impl SteadyLever {
    /// One step; `noise_band`: half-width of the noise band.
    pub fn follow(&mut self, sample: MilliDegree, noise_band: MilliDegree) -> MilliDegree {
        let away = sample - MilliDegree(self.fine >> BITS);
        self.fine = self.fine.saturating_add(away.0);
        let noise_band = if away.magnitude() > STEP_LIMIT {
            MilliDegree::ZERO
        } else {
            noise_band
        };
        let steady =
            MilliDegree(self.fine >> BITS).limited(sample - noise_band, sample + noise_band);
        // Whole millidegrees only where it was taken along.
        if steady.0 != self.fine >> BITS {
            self.fine = steady.0.saturating_mul(1 << BITS);
        }
        steady
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOISE_BAND: MilliDegree = MilliDegree(200);

    #[test]
    fn a_hand_is_followed_at_once_and_exactly_soon_after() {
        let mut lever = SteadyLever::default();
        let at = |lever: &mut SteadyLever, sample| lever.follow(MilliDegree(sample), NOISE_BAND).0;
        assert_eq!(at(&mut lever, 90_000), 90_000);
        assert_eq!(at(&mut lever, 90_700), 90_500);
        let after = (0..150).fold(0, |_, _| at(&mut lever, 90_700));
        assert!((90_690..=90_700).contains(&after), "{after}");
        assert_eq!(at(&mut lever, 120_000), 120_000);
        for step in 1..1_000 {
            let sample = 120_000 - 30 * step;
            let lag = at(&mut lever, sample) - sample;
            assert!((0..=200).contains(&lag), "{lag} at 30 degrees a second");
        }
    }

    #[test]
    fn noise_hardly_moves_it() {
        let mut lever = SteadyLever::default();
        let mut random = 1_u32;
        let mut noise = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 16).cast_signed() % 160 - 80
        };
        for step in 0..100_000 {
            let steady = lever.follow(MilliDegree(90_000 + noise() + noise()), NOISE_BAND);
            let error = (steady.0 - 90_000).abs();
            assert!(step < 300 || error < 70, "{error} mdeg");
        }
    }

    #[test]
    fn extremes_stay_finite() {
        for sample in [i32::MIN, -1, 0, 1, i32::MAX] {
            let mut lever = SteadyLever { fine: i32::MAX };
            let _ = lever.follow(MilliDegree(sample), NOISE_BAND);
            let _ = lever.follow(MilliDegree(sample), NOISE_BAND);
        }
    }
}
