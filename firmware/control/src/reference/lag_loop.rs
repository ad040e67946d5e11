//! A loop around an implement that follows its links with a lag: proportional and integral, without a step at its start, and
//! with back-calculation.
//!
//! ```text
//! u  = I + k e            k = w T,  T = length / speed
//! I' = w e + w (v - u)    v: the set point that was really used
//! ```
//!
//! `e` is an error as an angle, `w` the crossover. With `k`, the zero of the loop cancels the lag of an implement that follows
//! its links over its length: the open loop is `w / s`. Where another demand or a limit is in force, `I` follows it with
//! the time constant of the loop, `1 / w`.

use hitch_quantities::fixed::{Divisor, mul_div, mul_shift_16};
use hitch_quantities::units::{MilliDegree, MilliHertz, Millimetre, MillimetrePerSecond};

use super::low_pass::RADIAN;

/// Fraction bits of the integral.
const BITS: u32 = 10;
/// Largest magnitude of an angle in the loop: a full turn.
const LARGEST: MilliDegree = MilliDegree(360_000);
/// Lowest speed of the lag's time: half of walking speed.
const LOWEST_SPEED: MillimetrePerSecond = MillimetrePerSecond(500);

/// Gains of a loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gains {
    /// Change of the integral in a step, of 2^-26 of the error.
    integral: i32,
    /// Proportional gain, of 2^-16.
    proportional: i32,
}

impl Gains {
    /// Gains by crossover, and by the length and the speed of the implement.
    #[must_use]
    pub fn of(crossover: MilliHertz, length: Millimetre, speed: MillimetrePerSecond) -> Self {
        let speed = Divisor::at_least_one(speed.max(LOWEST_SPEED).0);
        let lag = mul_div(length.0, 1_000, speed);
        Self {
            integral: mul_shift_16(crossover.0 << BITS, RADIAN),
            proportional: mul_shift_16(crossover.0.saturating_mul(lag), RADIAN),
        }
    }

    /// What a quantity behind the implement's lag will be once the implement has followed: `x + T x'`, with `x'` of a low-pass
    /// at the crossover, whose output is `slow`.
    #[must_use]
    pub fn ahead(self, quantity: i32, slow: i32) -> i32 {
        let away = quantity.saturating_sub(slow);
        quantity.saturating_add(mul_shift_16(away, self.proportional))
    }

    /// The proportional part of an error.
    #[must_use]
    pub fn proportional(self, error: MilliDegree) -> MilliDegree {
        MilliDegree(mul_shift_16(error.0, self.proportional))
    }
}

/// The integral of a loop.
#[derive(Clone, Copy, Debug, Default)]
pub struct Integral {
    fine: i32,
}

impl Integral {
    /// A value.
    #[must_use]
    pub fn at(value: MilliDegree) -> Self {
        Self {
            fine: value.limited(-LARGEST, LARGEST).0 << BITS,
        }
    }

    /// The value.
    #[must_use]
    pub const fn value(self) -> MilliDegree {
        MilliDegree(self.fine >> BITS)
    }

    /// The value, brought between `low` and `high`.
    #[must_use]
    pub fn limited(self, low: MilliDegree, high: MilliDegree) -> Self {
        let (low, high) = (Self::at(low), Self::at(high));
        Self {
            fine: self.fine.max(low.fine).min(high.fine),
        }
    }

    /// One step with an error.
    pub fn add(&mut self, error: MilliDegree, gains: Gains) {
        let error = error.limited(-LARGEST, LARGEST);
        let change = mul_shift_16(error.0, gains.integral);
        let sum = Self {
            fine: self.fine.saturating_add(change),
        };
        *self = sum.limited(-LARGEST, LARGEST);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_integral_grows_by_the_crossover_times_the_error() {
        let gains = Gains::of(
            MilliHertz(200),
            Millimetre(1_500),
            MillimetrePerSecond(1_800),
        );
        let mut integral = Integral::at(MilliDegree(60_000));
        for _ in 0..1_000 {
            integral.add(MilliDegree(5_000), gains);
        }
        let exact = 60_000.0 + 5_000.0 * core::f64::consts::TAU * 0.2;
        let error = f64::from(integral.value().0) - exact;
        assert!(error.abs() < 10.0, "{integral:?}, not {exact}");
        let proportional = f64::from(gains.proportional(MilliDegree(10_000)).0);
        let exact = 10_000.0 * core::f64::consts::TAU * 0.2 * 1.5 / 1.8;
        assert!(
            (proportional - exact).abs() < 10.0,
            "{proportional}, not {exact}"
        );
    }

    #[test]
    fn extremes_stay_finite() {
        for word in [i32::MIN, -1, 0, 1, i32::MAX] {
            let gains = Gains::of(MilliHertz(500), Millimetre(word), MillimetrePerSecond(word));
            let mut integral = Integral::at(MilliDegree(word));
            integral.add(MilliDegree(word), gains);
            let _ = (integral.value(), gains.proportional(MilliDegree(word)));
        }
    }
}
