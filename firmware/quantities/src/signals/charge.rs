//! Charge that has gone through each coil: what loggers reckon mean currents from.
//!
//! A sample of a current with dither says where in its period the dither is; sampled more slowly it looks like steps of
//! a tenth of an ampere that no valve felt. And a coil is cut within a millisecond, of which samples know nothing. But
//! what charge has grown by since the last sample is the whole current, however far the samples are apart.

use super::Inputs;
use crate::fixed::Divisor;
use crate::units::MilliAmp;

/// Charge through the lift and the lowering coil, microcoulombs: a milliampere for a millisecond is one. Goes round.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CoilCharge(pub [i32; 2]);

impl CoilCharge {
    /// A step later. What isn't measured counts as none.
    #[must_use]
    pub fn after(self, inputs: &Inputs) -> Self {
        let Self([lift, lower]) = self;
        let more = |charge: i32, current: Option<MilliAmp>| {
            charge.wrapping_add(current.map_or(0, |value| value.0))
        };
        Self([
            more(lift, inputs.lift_current),
            more(lower, inputs.lower_current),
        ])
    }

    /// Mean currents since the charge was `earlier`, so many steps ago.
    #[must_use]
    pub fn mean_since(self, earlier: Self, steps: Divisor) -> [MilliAmp; 2] {
        let ([lift, lower], [lift_then, lower_then]) = (self.0, earlier.0);
        [(lift, lift_then), (lower, lower_then)]
            .map(|(now, then)| MilliAmp(steps.divide(now.wrapping_sub(then))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lifting(lift_ma: i32) -> Inputs {
        Inputs {
            lift_current: Some(MilliAmp(lift_ma)),
            ..Inputs::default()
        }
    }

    #[test]
    fn a_dither_leaves_no_trace() {
        let before = CoilCharge([i32::MAX - 5_000, 0]);
        let charge = (0..16).fold(before, |charge, step| {
            charge.after(&lifting(if step % 8 < 4 { 1_600 } else { 1_400 }))
        });
        let mean = charge.mean_since(before, Divisor::at_least_one(16));
        assert_eq!(mean, [MilliAmp(1_500), MilliAmp::ZERO]);
    }

    #[test]
    fn a_current_that_is_cut_leaves_when() {
        let charge = (0..10).fold(CoilCharge::default(), |charge, step| {
            charge.after(&lifting(if step < 3 { 2_000 } else { 0 }))
        });
        let mean = charge.mean_since(CoilCharge::default(), Divisor::at_least_one(10));
        assert_eq!(mean[0], MilliAmp(600));
    }
}
