//! The few integer operations that the controller is built from. None of them can panic.

use core::num::NonZeroU32;

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

    /// `a / self`, rounded to nearest with halves away from zero.
    #[must_use]
    pub fn divide(self, a: i32) -> i32 {
        let half = self.0.get() / 2;
        let magnitude = a.unsigned_abs().saturating_add(half) / self.0;
        with_sign(u64::from(magnitude), a < 0)
    }
}

/// `a * b / c`, exact product, rounded to nearest with halves away from zero, saturating.
///
/// A product that fits in 32 bits, as nearly all do, is divided by the hardware in one instruction.
#[must_use]
pub fn mul_div(a: i32, b: i32, c: Divisor) -> i32 {
    let product = u64::from(a.unsigned_abs()) * u64::from(b.unsigned_abs());
    let half = c.0.get() / 2;
    // The product is at most 2^62, so adding half a divisor can't overflow.
    let rounded = product.saturating_add(u64::from(half));
    let magnitude = match u32::try_from(rounded) {
        Ok(short) => u64::from(short / c.0),
        Err(_) => rounded / core::num::NonZeroU64::from(c.0),
    };
    with_sign(magnitude, (a < 0) != (b < 0))
}

/// `a * b / 2^16`, exact product, rounded to nearest with halves away from zero, saturating.
#[must_use]
pub fn mul_shift_16(a: i32, b: i32) -> i32 {
    let product = u64::from(a.unsigned_abs()) * u64::from(b.unsigned_abs());
    with_sign(product.saturating_add(1 << 15) >> 16, (a < 0) != (b < 0))
}

/// `sqrt(a / b)` in units of 2^-16, for ratios below 2^15; arguments are limited to 1 .. 2^19 - 1.
///
/// The quotient is divided out in digits of 13 bits, the most that a remainder below 2^19 leaves room for in a
/// 32-bit division; one 64-bit division costs more than the three together.
#[must_use]
pub fn square_root_of_ratio_16(a: i32, b: i32) -> i32 {
    const LARGEST: i32 = (1 << 19) - 1;
    let limited = |value: i32| value.max(1).min(LARGEST).unsigned_abs();
    let (mut rest, divisor) = (limited(a), Divisor::at_least_one(b.min(LARGEST)).0);
    let mut digit = |bits: u32| {
        let shifted = rest << bits;
        rest = shifted % divisor;
        u64::from(shifted / divisor)
    };
    let whole = digit(0);
    let fraction = (digit(13) << 19) | (digit(13) << 6) | digit(6);
    square_root((whole << 32) | fraction)
}

fn with_sign(magnitude: u64, negative: bool) -> i32 {
    let value = i32::try_from(magnitude).unwrap_or(i32::MAX);
    if negative {
        value.saturating_neg()
    } else {
        value
    }
}

/// `sqrt(value)`, rounded down.
#[must_use]
pub fn square_root(value: u64) -> i32 {
    i32::try_from(value.isqrt()).unwrap_or(i32::MAX)
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
    fn short_and_long_division_agree_where_they_meet() {
        // 65 537 * 65 535 is the largest 32-bit product; rounding carries it over the edge.
        for (a, b) in [(65_537, 65_535), (65_536, 65_536), (65_537, 65_536)] {
            for c in 1..1_000 {
                let exact = (i64::from(a) * i64::from(b) + i64::from(c / 2)) / i64::from(c);
                let expected = i32::try_from(exact).unwrap_or(i32::MAX);
                assert_eq!(
                    mul_div(a, b, Divisor::at_least_one(c)),
                    expected,
                    "{a} * {b} / {c}"
                );
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
    fn roots_of_ratios_are_exact_to_their_last_bit() {
        for a in [1, 2, 1_000, 15_000, 15_001, 250_000, 524_287] {
            for b in (1..524_288).step_by(997) {
                let exact = (f64::from(a) / f64::from(b)).sqrt() * 65_536.0;
                let found = f64::from(square_root_of_ratio_16(a, b));
                assert!(
                    (found - exact).abs() <= 1.0,
                    "sqrt({a} / {b}): {found}, not {exact}"
                );
            }
        }
    }

    #[test]
    fn a_vertical_step_of_a_table_has_a_value() {
        assert_eq!(interpolate((5, 1), (5, 9), 5), 1);
        assert_eq!(interpolate((0, 0), (10, 5), 5), 3);
    }
}
