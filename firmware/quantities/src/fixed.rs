//! The few integer operations that the controller is built from. None of them can panic.

use core::num::{NonZeroU16, NonZeroU32, NonZeroU64};

/// A positive divisor: that it isn't zero is settled once, where it is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Divisor(NonZeroU32);

impl Divisor {
    /// One.
    pub const ONE: Self = Self(NonZeroU32::MIN);
    /// A thousand: the step from a unit to its thousandth, and from seconds to milliseconds.
    pub const THOUSAND: Self = match NonZeroU32::new(1000) {
        Some(value) => Self(value),
        None => Self::ONE,
    };

    /// `value`, or one if it is smaller.
    #[must_use]
    pub const fn at_least_one(value: i32) -> Self {
        if value < 1 {
            return Self::ONE;
        }
        match NonZeroU32::new(value.unsigned_abs()) {
            Some(value) => Self(value),
            None => Self::ONE,
        }
    }

    /// `a / self`, rounded down.
    #[must_use]
    pub fn quotient(self, a: u32) -> u32 {
        a / self.0
    }

    /// `a / self`, rounded to nearest with halves away from zero.
    #[must_use]
    pub fn divide(self, a: i32) -> i32 {
        let half = self.0.get() / 2;
        // A magnitude is 2^31 at most, and half a divisor below 2^30.
        let magnitude = a.unsigned_abs().wrapping_add(half) / self.0;
        opposite_if(magnitude.cast_signed(), a >> 31)
    }
}

/// One step of a first-order lag: `value` comes closer to `goal` by the difference over the lag in steps.
#[must_use]
pub fn behind(value: i32, goal: i32, lag: Divisor) -> i32 {
    value.saturating_add(lag.divide(goal.saturating_sub(value)))
}

/// `a * b / c`, exact product, rounded to nearest with halves away from zero, saturating.
///
/// Most products fit a word, for which few instructions will do.
#[must_use]
pub fn mul_div(a: i32, b: i32, c: Divisor) -> i32 {
    match a.checked_mul(b) {
        Some(product) => c.divide(product),
        None => mul_div_long(a, b, c),
    }
}

/// The same for a long product. Not inlined: every product and quotient of the controller has this path.
#[inline(never)]
fn mul_div_long(a: i32, b: i32, c: Divisor) -> i32 {
    let product = u64::from(a.unsigned_abs()) * u64::from(b.unsigned_abs());
    let half = u64::from(c.0.get() / 2);
    // The product is below 2^62, so adding half a divisor can't overflow.
    with_sign(
        quotient(product.wrapping_add(half), c.0),
        (a < 0) != (b < 0),
    )
}

/// `dividend / divisor`.
///
/// The ECU divides 32 bits in one instruction and 64 in a hundred. Short numbers are the rule, and for
/// them the former will do.
fn quotient(dividend: u64, divisor: NonZeroU32) -> u64 {
    match u32::try_from(dividend) {
        Ok(short) => u64::from(short / divisor),
        Err(_) => long_quotient(dividend, divisor),
    }
}

/// The same for a long dividend; not inlined, for it is long and has many callers.
#[inline(never)]
fn long_quotient(dividend: u64, divisor: NonZeroU32) -> u64 {
    match NonZeroU16::try_from(divisor) {
        Ok(short) => quotient_by_digits(dividend, NonZeroU32::from(short)),
        Err(_) => dividend / NonZeroU64::from(divisor),
    }
}

/// Division as on paper, with digits of 16 bits: the divisor has one, so each step fits 32 bits.
fn quotient_by_digits(dividend: u64, one_digit: NonZeroU32) -> u64 {
    let high = (dividend >> 32) as u32;
    let middle = (high % one_digit) << 16 | (dividend >> 16 & 0xFFFF) as u32;
    let low = (middle % one_digit) << 16 | (dividend & 0xFFFF) as u32;
    u64::from(high / one_digit) << 32
        | u64::from(middle / one_digit) << 16
        | u64::from(low / one_digit)
}

/// `a * b / 2^16`, exact product, rounded to nearest with halves away from zero, saturating.
#[must_use]
pub fn mul_shift_16(a: i32, b: i32) -> i32 {
    let product = u64::from(a.unsigned_abs()) * u64::from(b.unsigned_abs());
    with_sign(product.wrapping_add(1 << 15) >> 16, (a < 0) != (b < 0))
}

fn with_sign(magnitude: u64, negative: bool) -> i32 {
    let value = i32::try_from(magnitude).unwrap_or(i32::MAX);
    opposite_if(value, -i32::from(negative))
}

/// The opposite of `value` if `sign` is all ones, `value` if it is zero: a number's complement plus one is its
/// opposite.
const fn opposite_if(value: i32, sign: i32) -> i32 {
    (value ^ sign).wrapping_sub(sign)
}

/// `sqrt(value)` from its leading 31 or 32 bits: at most 2^-15 of it too small.
///
/// A root of 32 bits costs a quarter of one of 64, which needs a long division.
#[must_use]
pub fn square_root(value: u64) -> i32 {
    let excess = 32_u32.saturating_sub(value.leading_zeros());
    // An even shift halves into the root.
    let half = excess.saturating_add(1) / 2;
    let short = u32::try_from(value >> (half << 1)).unwrap_or(u32::MAX);
    let root = u64::from(short.isqrt()) << half;
    i32::try_from(root).unwrap_or(i32::MAX)
}

/// One breakpoint of a table, as `(x, y)`.
pub type Breakpoint = (i32, i32);

/// `y` at `x` on the straight line through two breakpoints; the left `y` if they share their `x`.
#[must_use]
pub fn interpolate(left: Breakpoint, right: Breakpoint, x: i32) -> i32 {
    let run = right.0.saturating_sub(left.0);
    if run <= 0 {
        return left.1;
    }
    let rise = right.1.saturating_sub(left.1);
    let along = x.saturating_sub(left.0);
    left.1
        .saturating_add(mul_div(rise, along, Divisor::at_least_one(run)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn division_rounds_to_nearest_away_from_zero() {
        let three = Divisor::at_least_one(3);
        assert_eq!(
            [
                three.divide(4),
                three.divide(5),
                three.divide(-4),
                three.divide(-5)
            ],
            [1, 2, -1, -2]
        );
        assert_eq!(Divisor::ONE.divide(i32::MIN), i32::MIN);
        assert_eq!(Divisor::at_least_one(i32::MAX).divide(i32::MAX), 1);
        let two = Divisor::at_least_one(2);
        assert_eq!([two.divide(3), two.divide(-3)], [2, -2]);
    }

    #[test]
    fn products_are_exact_and_saturate() {
        assert_eq!(
            mul_div(
                2_000_000_000,
                2_000_000_000,
                Divisor::at_least_one(2_000_000_000)
            ),
            2_000_000_000
        );
        assert_eq!(mul_div(i32::MIN, i32::MAX, Divisor::ONE), -i32::MAX);
        assert_eq!(mul_div(i32::MIN, i32::MIN, Divisor::ONE), i32::MAX);
        assert_eq!(mul_div(-7, 3, Divisor::at_least_one(2)), -11);
    }

    #[test]
    fn every_way_to_divide_gives_the_quotient() {
        let divisors = (1..2_000)
            .chain(65_000..66_000)
            .chain([i32::MAX - 1, i32::MAX]);
        for divisor in divisors.filter_map(|value| NonZeroU32::new(value as u32)) {
            for bits in [1, 16, 31, 32, 33, 47, 48, 49, 62] {
                for dividend in [1_u64 << bits, (1 << bits) - 1, (1 << bits) / 7 * 5 + 12_345] {
                    let expected = dividend / u64::from(divisor.get());
                    assert_eq!(
                        quotient(dividend, divisor),
                        expected,
                        "{dividend} / {divisor}"
                    );
                }
            }
        }
    }

    #[test]
    fn short_and_long_divisions_meet() {
        for a in [1, 3, 46_341, 65_535, 65_536, 99_999, i32::MAX] {
            for b in [1, 2, 46_341, 65_536, 65_537, i32::MAX] {
                for c in [1, 2, 3, 1_000, i32::MAX] {
                    let exact = (i128::from(a) * i128::from(b) + i128::from(c / 2)) / i128::from(c);
                    let exact = exact.min(i128::from(i32::MAX));
                    assert_eq!(i128::from(mul_div(a, b, Divisor::at_least_one(c))), exact);
                }
            }
        }
    }

    #[test]
    fn shifts_are_divisions() {
        let divisor = Divisor::at_least_one(1 << 16);
        for a in [
            i32::MIN,
            -70_000,
            -1,
            0,
            1,
            32_767,
            32_768,
            1_000_000,
            i32::MAX,
        ] {
            for b in [i32::MIN, -65_536, -1, 0, 1, 65_535, 570_000, i32::MAX] {
                assert_eq!(mul_shift_16(a, b), mul_div(a, b, divisor), "{a} * {b}");
            }
        }
    }

    #[test]
    fn roots_are_a_little_too_small_at_most() {
        let near_powers =
            (0..64).flat_map(|bits| [1_u64 << bits, (1 << bits) - 1, (1 << bits) / 7 * 5]);
        for value in near_powers.chain([u64::MAX, 0, 1, 2, 3]) {
            let exact = (value as f64).sqrt().min(f64::from(i32::MAX));
            let found = f64::from(square_root(value));
            assert!(
                found <= exact && found >= exact * (1.0 - 1.0 / 32_768.0) - 1.0,
                "sqrt({value}): {found}, not {exact}"
            );
        }
    }

    #[test]
    fn a_vertical_step_of_a_table_has_a_value() {
        assert_eq!(interpolate((5, 1), (5, 9), 5), 1);
        assert_eq!(interpolate((0, 0), (10, 5), 5), 3);
    }
}
