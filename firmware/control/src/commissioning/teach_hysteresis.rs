//! The hysteresis of a valve, taught: how much further than it rose the current has to fall until the hitch slows down.
//!
//! While the current falls at a rate `s` the spool stays where it is for `H / s`, then it follows, and goes through the
//! curve on which it opened. The twin has no hysteresis and follows at once:
//!
//! ```text
//! way while it falls = v (H / s + c)      c: the curve's, and the lag's      H = s (t - t_twin)     t: that way over v
//! ```
//!
//! That leaves out by how much the spool's lag differs from the twin's: 10 ms make 4 mA of it. A valve with less than
//! the calibration says (dither can take all of it) is left at that: believing in more than there is makes a hitch stop
//! a bit sooner, believing in less sends it beyond its set point.

use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{MilliAmp, MilliAmpPerSecond};

use super::teach_lag::Way;

/// Longest that the spool of any valve stays, ms: beyond it something else carried the hitch on.
const LONGEST: i32 = 750;

/// The hysteresis of a valve whose hitch went the `real` way where one without went the `twin` way, as the current fell
/// at `rate`: at least what is `known`, and just that if one of them stood still.
#[must_use]
pub fn found(real: &Way, twin: &Way, rate: MilliAmpPerSecond, known: MilliAmp) -> MilliAmp {
    let (Some(real), Some(twin)) = (real.coasting_time(), twin.coasting_time()) else {
        return known;
    };
    let later = real.saturating_sub(twin).clamp(0, LONGEST);
    // No ramp is steeper than 10 A/s: a word holds the product.
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
