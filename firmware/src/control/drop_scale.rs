//! How the lowering valve's flow goes with its pressure drop.
//!
//! ```text
//!   Q = Cd A sqrt(2 dp / rho), so Q_ref = Q sqrt(dp_ref / dp)
//! ```
//!
//! `1 / sqrt(dp)` comes from a table over the leading bits of `dp`: with an even number of them shifted out, the
//! exponent halves into a shift of the result. What depends on the reference alone is worked out once.

use super::fixed::square_root;
use super::units::{MicroLitrePerSecond, MilliBar, MillimetrePerSecondSquared};

/// Bits behind the point of a scale.
const SCALE_BITS: u32 = 25;
/// What is scaled is limited to so many bits, so that with the scale's it fills a word.
const SCALED_BITS: u32 = 24;

/// Smallest and largest pressure drop that there is a scale for: the validated ones are well inside.
const DROPS: (i32, i32) = (64, (1 << 19) - 1);
/// The same for the drop at which a table was measured.
const REFERENCES: (i32, i32) = (1_000, 250_000);

/// The pressure drop at which a table was measured, as its scale needs it.
#[derive(Clone, Copy, Debug)]
pub struct DropReference {
    /// Its root, in 2^-22.
    root: u32,
    /// One over its root, in 2^-36.
    inverse_root: u32,
}

impl DropReference {
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
            root: u32::try_from(root).unwrap_or(u32::MAX),
            inverse_root: u32::try_from(inverse).unwrap_or(u32::MAX),
        }
    }
}

/// `sqrt(dp_ref / dp)` of the lowering valve at its present pressure drop.
#[derive(Clone, Copy, Debug)]
pub struct DropScale {
    /// The ratio, in 2^-25.
    ratio: i32,
    /// Its inverse, in 2^-25.
    inverse: i32,
}

impl DropScale {
    /// The scale at pressure drop `drop` of a table that was measured at `reference`, within 0.01 %. Drops are limited
    /// to 64 mbar .. 524 bar.
    #[must_use]
    pub fn new(reference: &DropReference, drop: MilliBar) -> Self {
        let drop = drop.0.clamp(DROPS.0, DROPS.1).cast_unsigned();
        // 6 to 12: the drop has 7 to 19 bits.
        let half = drop.leading_zeros() / 2;
        let mantissa = drop << (half * 2);
        let inverse_root = inverse_root(mantissa);
        let ratio = high_word(reference.root, inverse_root) >> (12 - half);
        let root = high_word(mantissa, inverse_root);
        let inverse = high_word(root, reference.inverse_root) >> (half - 6);
        Self {
            ratio: ratio.cast_signed(),
            inverse: inverse.cast_signed(),
        }
    }

    /// The flow at the reference drop that needs the same opening as `flow` does at the present one.
    #[must_use]
    pub fn to_reference(self, flow: MicroLitrePerSecond) -> MicroLitrePerSecond {
        MicroLitrePerSecond(scaled(flow.0, self.ratio))
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

/// `value * scale`, rounded to nearest; values are limited to 24 bits and a sign.
fn scaled(value: i32, scale: i32) -> i32 {
    const MOST: i32 = (1 << SCALED_BITS) - 1;
    let value = value.clamp(-MOST, MOST) << (32 - SCALE_BITS);
    let product = i64::from(value).wrapping_mul(i64::from(scale));
    (product.wrapping_add(1 << 31) >> 32) as i32
}

/// The upper half of a product.
fn high_word(a: u32, b: u32) -> u32 {
    (u64::from(a).wrapping_mul(u64::from(b)) >> 32) as u32
}

/// Leading bits of a mantissa that choose an entry of the table: 32 to 127, for the two highest aren't both zero.
const INDEX_BITS: u32 = 7;
const ENTRIES: usize = (1 << INDEX_BITS) + 1;

/// `1 / sqrt(mantissa / 2^30)` in 2^-16, at each value of the leading bits; what is below 32 is not used.
///
/// Between its points a straight line lies above this curve, by 9.2e-5 at most: the points are half of that too low.
static INVERSE_ROOTS: [u16; ENTRIES] = inverse_roots();

const fn inverse_roots() -> [u16; ENTRIES] {
    let mut entries = [u16::MAX; ENTRIES];
    let mut index = 32;
    while index < ENTRIES {
        // 2^16 / sqrt(index / 32); half of the line's error is 3 * 2^-16 at 1, and goes with the fifth power.
        let root = ((1_u64 << 37) / index as u64).isqrt();
        let square = (root * root) >> 16;
        let fifth_power = (((square * square) >> 16) * root) >> 16;
        entries[index] = (root - ((3 * fifth_power) >> 16)) as u16;
        index += 1;
    }
    entries
}

/// `1 / sqrt(mantissa / 2^30)` in 2^-32.
fn inverse_root(mantissa: u32) -> u32 {
    let index = (mantissa >> (32 - INDEX_BITS)) as usize;
    let (left, right) = (
        u32::from(INVERSE_ROOTS[index]),
        u32::from(INVERSE_ROOTS[index + 1]),
    );
    let along = mantissa >> 9 & 0xFFFF;
    (left << 16).wrapping_sub(left.wrapping_sub(right).wrapping_mul(along))
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
                let exact = (f64::from(reference) / f64::from(drop)).sqrt();
                let scale = DropScale::new(&known, MilliBar(drop));
                let one = f64::from(1 << SCALE_BITS);
                let errors = [
                    f64::from(scale.ratio) / one / exact - 1.0,
                    f64::from(scale.inverse) / one * exact - 1.0,
                ];
                worst = errors.into_iter().map(f64::abs).fold(worst, f64::max);
            }
        }
        assert!(worst <= 1e-4, "{worst}");
    }

    #[test]
    fn more_drop_is_never_a_larger_ratio() {
        let reference = DropReference::new(MilliBar(15_000));
        let mut last = i32::MAX;
        for drop in 1..524_288 {
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
                assert!(scale.to_reference(most) > MicroLitrePerSecond::ZERO);
                assert!(scale.to_present(-most) < MicroLitrePerSecond::ZERO);
            }
        }
    }
}
