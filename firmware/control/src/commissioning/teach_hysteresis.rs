//! Identification of the hysteresis of a valve: the additional fall of the current before the hitch slows down.
//!
//! While the current falls at a rate `s`, the spool remains in place for `H / s`, then follows and passes the curve on
//! which it opened. The twin has no hysteresis and follows immediately:
//!
//! ```text
//! way while it falls = v (H / s + c)      c: the curve's, and the lag's      H = s (t - t_twin)     t: that way over v
//! ```
//!
//! A difference between the lags of spool and twin is neglected: 10 ms give an error of 4 mA. A valve with less
//! hysteresis than calibrated (dither can remove all of it) keeps the calibrated value: a value that is too large makes
//! a hitch stop slightly early, and one that is too small causes overshoot.

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{MilliAmp, MilliAmpPerSecond};

use super::teach_lag::Way;

/// Longest time that a spool remains in place, ms; beyond it the hitch moved for another reason.
const LONGEST: i32 = 750;

/// Hysteresis of a valve from the `real` travel and the `twin` travel while the current falls at `rate`. At least
/// `known`, and `known` if one of them stood still.
#[must_use]
pub fn found(real: &Way, twin: &Way, rate: MilliAmpPerSecond, known: MilliAmp) -> MilliAmp {
    let (Some(real), Some(twin)) = (real.coasting_time(), twin.coasting_time()) else {
        return known;
    };
    let later = real.saturating_sub(twin).clamp(0, LONGEST);
    // Ramps are at most 10 A/s, so the product fits a word.
    MilliAmp(Divisor::THOUSAND.divide(later.wrapping_mul(rate.0))).max(known)
}

#[cfg(test)]
mod tests {
    use hitch_quantities::units::{Micrometre, Millisecond};

    use super::*;
    use crate::commissioning::teach_lag::STEP;

    const KNOWN: MilliAmp = MilliAmp(80);
    const RATE: MilliAmpPerSecond = MilliAmpPerSecond(400);

    /// The way at a steady `speed`, um/ms, which goes on for `coasting_time` ms once the current falls.
    fn way(speed: i32, coasting_time: i32) -> Way {
        let mut way = Way::default();
        for age in 0..STEP.0 + 1_500 {
            let gone = Micrometre(speed * age.min(STEP.0 + coasting_time));
            way.note(Millisecond(age), gone);
        }
        way
    }

    fn hysteresis(real: &Way, twin: &Way) -> i32 {
        found(real, twin, RATE, KNOWN).0
    }

    #[test]
    fn the_hysteresis_is_what_the_current_falls_until_the_hitch_slows_down() {
        let twin = way(17, 130);
        for speed in [8, 17, 30] {
            for (coasting_time, exact) in [(380, 100), (505, 150), (630, 200)] {
                let found = hysteresis(&way(speed, coasting_time), &twin);
                assert!((found - exact).abs() <= 1, "{found}, not {exact} mA");
            }
        }
    }

    #[test]
    fn less_than_is_known_and_what_is_implausible_is_not_believed() {
        let twin = way(17, 130);
        for real in [way(17, 130), way(17, 0), Way::default(), way(-17, 300)] {
            assert_eq!(hysteresis(&real, &twin), KNOWN.0);
        }
        assert_eq!(hysteresis(&twin, &Way::default()), KNOWN.0);
        assert_eq!(hysteresis(&way(17, 1_400), &twin), 300, "carried on");
    }
}
