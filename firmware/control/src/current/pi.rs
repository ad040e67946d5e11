//! Proportional and integral part on the current error of a coil, with anti-windup.
//!
//! ```text
//!   u = rest + kp e + I        I' = I + ki e, unless u is below zero or beyond the supply, and e drives it further
//! ```
//!
//! A milliohm times a milliampere is a microvolt, so no term needs a division. Gains have 16 bits, which validation
//! ensures, and errors 14 bits including the sign, so that a product fits a word without a check.

use hitch_quantities::calibration::design_parameters::CurrentParameters;
use hitch_quantities::units::MilliAmp;

/// Largest error: 13 bits and a sign, to which a single instruction limits.
const MOST_ERROR: i32 = (1 << 13) - 1;

/// Gains from a current's error to a voltage, in milliohms.
#[derive(Clone, Copy, Debug)]
pub struct Gains {
    proportional: u16,
    integral: u16,
}

impl Gains {
    /// Those of a calibration.
    #[must_use]
    pub const fn of(parameters: &CurrentParameters) -> Self {
        // Validation permits at most 50 000 and 20 000.
        Self {
            proportional: parameters.proportional.0 as u16,
            integral: parameters.integral.0 as u16,
        }
    }
}

/// Range of the voltage.
#[derive(Clone, Copy, Debug)]
pub struct VoltageRange {
    /// Smallest: the voltage against which the current flows on while the driver is off.
    pub least_uv: i32,
    /// Largest: the supply.
    pub most_uv: i32,
}

/// State of the regulator.
#[derive(Clone, Copy, Debug, Default)]
pub struct ProportionalIntegral {
    integral_uv: i32,
}

impl ProportionalIntegral {
    /// Without integral part.
    pub const NEW: Self = Self { integral_uv: 0 };

    /// Integral part, microvolt.
    #[must_use]
    pub const fn integral_uv(&self) -> i32 {
        self.integral_uv
    }

    /// Voltage, microvolt, for a current error; `rest_uv`: voltage without an error. The integral part never exceeds
    /// the largest voltage.
    #[must_use]
    pub fn step(
        &mut self,
        gains: Gains,
        error: MilliAmp,
        rest_uv: i32,
        given: &VoltageRange,
    ) -> i32 {
        let error = error.0.clamp(-MOST_ERROR - 1, MOST_ERROR);
        let change_uv = i32::from(gains.integral).wrapping_mul(error);
        let integral_uv = self.integral_uv.saturating_add(change_uv);
        let voltage_uv = i32::from(gains.proportional)
            .wrapping_mul(error)
            .saturating_add(rest_uv)
            .saturating_add(integral_uv);
        let at_most_uv = voltage_uv.min(given.most_uv);
        let beyond_uv = voltage_uv.saturating_sub(at_most_uv.max(0));
        // Equal signs, by the leading bit.
        let outwards = beyond_uv != 0 && beyond_uv ^ change_uv >= 0;
        if !outwards {
            let most_uv = given.most_uv;
            self.integral_uv = integral_uv.max(most_uv.saturating_neg()).min(most_uv);
        }
        at_most_uv.max(given.least_uv)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAINS: Gains = Gains {
        proportional: 5_000,
        integral: 1_000,
    };
    const GIVEN: VoltageRange = VoltageRange {
        least_uv: -700_000,
        most_uv: 12_000_000,
    };

    fn step(pi: &mut ProportionalIntegral, error: i32, rest_uv: i32) -> i32 {
        pi.step(GAINS, MilliAmp(error), rest_uv, &GIVEN)
    }

    #[test]
    fn parts_add_up() {
        let mut pi = ProportionalIntegral::NEW;
        assert_eq!(step(&mut pi, 100, 2_000_000), 2_600_000);
        assert_eq!(step(&mut pi, -50, 2_000_000), 1_800_000);
        assert_eq!(pi.integral_uv(), 50_000);
    }

    #[test]
    fn the_integral_stops_where_the_supply_ends_but_comes_back_at_once() {
        let mut pi = ProportionalIntegral::NEW;
        assert_eq!(step(&mut pi, 2_000, 4_000_000), GIVEN.most_uv);
        assert_eq!(pi.integral_uv(), 0);
        assert_eq!(step(&mut pi, -1_000, 18_000_000), GIVEN.most_uv);
        assert_eq!(pi.integral_uv(), -1_000_000);
        assert_eq!(step(&mut pi, -2_000, 4_000_000), GIVEN.least_uv);
        assert_eq!(pi.integral_uv(), -1_000_000);
        assert_eq!(step(&mut pi, 100, -9_000_000), GIVEN.least_uv);
        assert_eq!(pi.integral_uv(), -900_000);
        assert_eq!(step(&mut pi, -100, 1_200_000), -300_000);
        assert_eq!(pi.integral_uv(), -900_000);
    }

    #[test]
    fn the_integral_is_no_larger_than_the_supply() {
        let mut pi = ProportionalIntegral {
            integral_uv: 11_900_000,
        };
        assert_eq!(step(&mut pi, 1_000, -9_000_000), 8_900_000);
        assert_eq!(pi.integral_uv(), GIVEN.most_uv);
    }

    #[test]
    fn absurd_values_stay_bounded() {
        let most = Gains {
            proportional: u16::MAX,
            integral: u16::MAX,
        };
        for start in [i32::MIN, 0, i32::MAX] {
            for error in [i32::MIN, 0, i32::MAX] {
                for rest_uv in [i32::MIN, i32::MAX] {
                    let mut pi = ProportionalIntegral { integral_uv: start };
                    let voltage_uv = pi.step(most, MilliAmp(error), rest_uv, &GIVEN);
                    assert!((GIVEN.least_uv..=GIVEN.most_uv).contains(&voltage_uv));
                }
            }
        }
    }
}
