//! How the lowering valve's flow goes with its pressure drop.
//!
//! ```text
//!   Q = Cd A sqrt(2 dp / rho), so Q_ref = Q sqrt(dp_ref / dp)
//! ```
//!
//! The curve of the lowering valve is kept for the smallest drop, 64 mbar, whatever drop its table was measured at: then a
//! flow is brought to it by `8 / sqrt(dp)` alone, which is never more than one. `1 / sqrt(dp)` comes from a table over
//! the leading bits of `dp`: `dp = m 4^k` with `m` of a fixed number of bits gives `1 / sqrt(dp) = 2^-k / sqrt(m)`.
//! What depends on the reference alone is worked out once.

use hitch_quantities::fixed::square_root;
use hitch_quantities::units::{MicroLitrePerSecond, MilliBar, MillimetrePerSecondSquared};

use super::inverse_curve::FlowSteps;

/// Bits behind the point of a scale.
const SCALE_BITS: u32 = 25;
/// What is scaled is limited to so many bits, so that with the scale's it fills a word.
const SCALED_BITS: u32 = 24;

/// Smallest pressure drop that there is a scale for, and how much larger the largest is: the validated ones are well inside.
const LEAST_DROP: i32 = 64;
const DROP_RANGE: i32 = (1 << 19) - 1;
/// The limits of the drop at which a table was measured.
const REFERENCES: (i32, i32) = (1_000, 250_000);

/// The pressure drop at which a table was measured, as its scale needs it.
#[derive(Clone, Copy, Debug)]
pub struct DropReference {
    /// One over its root, in 2^-36.
    inverse_root: u32,
}

impl DropReference {
    /// None yet.
    pub const UNKNOWN: Self = Self { inverse_root: 0 };

    /// The reference of a drop between 1 and 250 bar; beyond these it is limited.
    #[must_use]
    pub fn new(drop: MilliBar) -> Self {
        let drop = drop.0.clamp(REFERENCES.0, REFERENCES.1);
        let squared = u64::from(drop.unsigned_abs()) << 44;
        // Half as many wrong bits: from 15 good ones to all of them.
        let nearly = u64::from(square_root(squared).unsigned_abs()).max(1);
        let root = squared
            .checked_div(nearly)
            .unwrap_or(0)
            .wrapping_add(nearly)
            / 2;
        let inverse = (1_u64 << 58).checked_div(root).unwrap_or(0);
        Self {
            inverse_root: u32::try_from(inverse).unwrap_or(u32::MAX),
        }
    }

    /// The steps that [`DropScale::steps`] counts flows in, for a table that was measured at this drop: 2^10 / sqrt(dp_ref)
    /// of them are a microlitre a second, at least 2.04.
    #[must_use]
    pub const fn steps(&self) -> FlowSteps {
        FlowSteps(self.inverse_root)
    }
}

/// The lowering valve's scale at its present pressure drop.
#[derive(Clone, Copy, Debug)]
pub struct DropScale {
    /// `sqrt(64 mbar / dp)`, in 2^-32.
    ratio: u32,
    /// `sqrt(dp / dp_ref)`, in 2^-25.
    inverse: i32,
}

impl DropScale {
    /// The scale at pressure drop `drop` of a table that was measured at `reference`, within 0.01 %. Drops are limited
    /// to 64 mbar .. 524 bar.
    #[must_use]
    pub fn new(reference: &DropReference, drop: MilliBar) -> Self {
        // To limit a number to zero and some bits takes one instruction.
        let above = drop.0.saturating_sub(LEAST_DROP).clamp(0, DROP_RANGE);
        let drop = (above + LEAST_DROP).cast_unsigned();
        // 6 to 12: the drop has 7 to 20 bits.
        let half = drop.leading_zeros() / 2;
        let mantissa = drop << (half * 2);
        let inverse_root = inverse_root(mantissa);
        let ratio = inverse_root >> (12 - half);
        let root = high_word(mantissa, inverse_root);
        let inverse = high_word(root, reference.inverse_root) >> (half - 6);
        Self {
            ratio,
            inverse: inverse.cast_signed(),
        }
    }

    /// The flow at the smallest drop that needs the same opening as `flow` does at the present one, in steps of 2^-7 ul/s,
    /// rounded down. At the largest drop the smallest flow is 1.4 of them: none are no flow.
    #[must_use]
    pub fn steps(self, flow: MicroLitrePerSecond) -> i32 {
        let finely = flow.0.clamp(0, MOST_SCALED).cast_unsigned() << 7;
        high_word(finely, self.ratio).cast_signed()
    }

    /// The flow at the present drop through an opening that lets `flow` through at the reference one.
    #[must_use]
    pub fn to_present(self, flow: MicroLitrePerSecond) -> MicroLitrePerSecond {
        MicroLitrePerSecond(scaled(flow.0, self.inverse))
    }

    /// An acceleration of the reference drop at the present one: ramps take the same time whatever the valve can give.
    #[must_use]
    pub fn ramp_at_present(self, slope: MillimetrePerSecondSquared) -> MillimetrePerSecondSquared {
        MillimetrePerSecondSquared(scaled(slope.0, self.inverse))
    }
}

/// The largest value that is scaled.
const MOST_SCALED: i32 = (1 << SCALED_BITS) - 1;

/// `value * scale`, rounded to nearest; values are limited to 24 bits and a sign.
fn scaled(value: i32, scale: i32) -> i32 {
    let value = value.clamp(-MOST_SCALED, MOST_SCALED) << (32 - SCALE_BITS);
    let product = i64::from(value).wrapping_mul(i64::from(scale));
    (product.wrapping_add(1 << 31) >> 32) as i32
}

/// The upper half of a product.
fn high_word(a: u32, b: u32) -> u32 {
    (u64::from(a).wrapping_mul(u64::from(b)) >> 32) as u32
}

/// Leading bits of a mantissa that choose an entry of the table: 32 to 127, for the two highest aren't both zero.
const INDEX_BITS: u32 = 7;
const ENTRIES: usize = 1 << INDEX_BITS;
/// Bits of a mantissa that say how far it is on to the next entry: with a sign, half a word for one multiplication.
const ALONG_BITS: u32 = 15;

/// `1 / sqrt(mantissa / 2^30)` in 2^-32, at each value of the leading bits; what is below 32 is not used.
///
/// Its lower half is how much it changes, a signed number, by each step on the way to the next one, and counts for
/// nothing in the whole. Between its points a straight line lies above this curve, by 9.2e-5 at most: the points are half of
/// that too low.
static INVERSE_ROOTS: [u32; ENTRIES] = inverse_roots();

const fn inverse_roots() -> [u32; ENTRIES] {
    let mut entries = [u32::MAX; ENTRIES];
    let mut index = ENTRIES - 1;
    // After the last one comes the first one again, of a quarter of the mantissa.
    let mut next = low_inverse_root(32) / 2;
    while index >= 32 {
        let root = low_inverse_root(index);
        // Rounded down, from half a unit of the upper half below: the line doesn't end below the next entry.
        let fall = ((root - next) - (1 << 15)) >> ALONG_BITS;
        let lower_half = (1 << 16) - fall;
        entries[index] = ((root - lower_half + (1 << 15)) & 0xFFFF_0000) | lower_half;
        next = entries[index];
        index -= 1;
    }
    entries
}

/// `1 / sqrt(index / 32)` in 2^-32, less half of what a straight line is too high.
const fn low_inverse_root(index: usize) -> u32 {
    let root = ((1_u128 << 69) / index as u128).isqrt();
    // Half of the line's error is 3 * 2^-16 at 1, and goes with the fifth power.
    let square = (root * root) >> 32;
    let fifth_power = (((square * square) >> 32) * root) >> 32;
    (root - ((3 * fifth_power) >> 16)) as u32
}

/// `1 / sqrt(mantissa / 2^30)` in 2^-32.
fn inverse_root(mantissa: u32) -> u32 {
    let entry = INVERSE_ROOTS[(mantissa >> (32 - INDEX_BITS)) as usize].cast_signed();
    let along = mantissa >> (32 - INDEX_BITS - ALONG_BITS) & ((1 << ALONG_BITS) - 1);
    let change = i32::from(entry as i16).wrapping_mul(along.cast_signed());
    entry.wrapping_add(change).cast_unsigned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_within_a_hundredth_of_a_percent() {
        let mut worst: f64 = 0.0;
        for reference in [1_000, 4_321, 15_000, 15_001, 250_000] {
            let known = DropReference::new(MilliBar(reference));
            for drop in (64..524_288).step_by(7) {
                let scale = DropScale::new(&known, MilliBar(drop));
                let ratio = f64::from(scale.ratio) / 2.0_f64.powi(32);
                let inverse = f64::from(scale.inverse) / f64::from(1 << SCALE_BITS);
                let [drop, reference] = [drop, reference].map(f64::from);
                let errors = [
                    ratio / (64.0 / drop).sqrt() - 1.0,
                    inverse / (drop / reference).sqrt() - 1.0,
                ];
                worst = errors.into_iter().map(f64::abs).fold(worst, f64::max);
            }
        }
        assert!(worst <= 1e-4, "{worst}");
    }

    #[test]
    fn more_drop_is_never_a_larger_ratio() {
        let reference = DropReference::new(MilliBar(15_000));
        let mut last = u32::MAX;
        for drop in 1..525_000 {
            let ratio = DropScale::new(&reference, MilliBar(drop)).ratio;
            assert!(ratio <= last, "{drop} mbar");
            last = ratio;
        }
    }

    #[test]
    fn absurd_values_stay_bounded() {
        for reference in [i32::MIN, 0, i32::MAX] {
            let reference = DropReference::new(MilliBar(reference));
            for drop in [i32::MIN, 0, 1, i32::MAX] {
                let scale = DropScale::new(&reference, MilliBar(drop));
                let most = MicroLitrePerSecond(i32::MAX);
                assert!(scale.steps(most) > 0 && scale.steps(MicroLitrePerSecond(1)) > 0);
                assert!(scale.steps(-most) == 0 && scale.steps(MicroLitrePerSecond::ZERO) == 0);
                assert!(scale.to_present(-most) < MicroLitrePerSecond::ZERO);
            }
        }
    }
}
