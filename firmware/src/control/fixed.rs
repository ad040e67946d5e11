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

    /// `a / self`, rounded to nearest with halves away from zero.
    #[must_use]
    pub fn divide(self, a: i32) -> i32 {
        let half = self.0.get() / 2;
        let magnitude = a.unsigned_abs().saturating_add(half) / self.0;
        with_sign(u64::from(magnitude), a < 0)
    }
}

/// `a * b / c`, exact product, rounded to nearest with halves away from zero, saturating.
#[must_use]
pub fn mul_div(a: i32, b: i32, c: Divisor) -> i32 {
    let product = u64::from(a.unsigned_abs()) * u64::from(b.unsigned_abs());
    let half = u64::from(c.0.get() / 2);
    // The product is below 2^62, so adding half a divisor can't overflow.
    with_sign(
        quotient(product.saturating_add(half), c.0),
        (a < 0) != (b < 0),
    )
}

/// `dividend / divisor`.
///
/// The ECU divides 32 bits in one instruction and 64 in a hundred. Short numbers are the rule, and for
/// them the former will do.
fn quotient(dividend: u64, divisor: NonZeroU32) -> u64 {
    if let Ok(short) = u32::try_from(dividend) {
        return u64::from(short / divisor);
    }
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
    fn a_vertical_step_of_a_table_has_a_value() {
        assert_eq!(interpolate((5, 1), (5, 9), 5), 1);
        assert_eq!(interpolate((0, 0), (10, 5), 5), 3);
    }
}
