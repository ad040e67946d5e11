//! Model of a load that sinks through a valve opening: gravity accelerates it, and the pressure rises with the square
//! of its speed.
//!
//! The cylinder carries the weight and the acceleration of the load, `p = p_rest (1 + R a / g)`, with the ratio `R` of
//! load travel to piston travel. The flow through an opening is proportional to the square root of `p`. With the
//! steady-state speed `v_s` of the opening
//!
//! ```text
//! v' = (g / R) (1 - (v / v_s)^2)
//! ```
//!
//! A fast opening cannot exceed free fall, and a closing valve passes more flow than in steady state. Near the steady
//! speed the load has a lag of `v_s R / 2g`, 40 ms at 190 mm/s, for every weight.

use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{Micrometre, MicrometrePerSecond};

/// `g / R` per millisecond, with `R` = 4.3 of the rig, which is accurate to 7 % over the whole stroke.
const FALL: MicrometrePerSecond = MicrometrePerSecond(2_281);
/// Unit of squared speeds, um/s: the ECU then divides 32 bits instead of 64.
const COARSE: i32 = 64;
/// `4 g / R` in um/s2, in units of its square.
const FOUR_FALLS: Divisor = Divisor::at_least_one(9_124_000 / (COARSE * COARSE));

/// Downward speed one millisecond after `speed`; `settled`: steady-state speed of the opening.
#[must_use]
pub fn next_speed(speed: MicrometrePerSecond, settled: MicrometrePerSecond) -> MicrometrePerSecond {
    if settled <= MicrometrePerSecond::ZERO {
        return MicrometrePerSecond::ZERO;
    }
    let settled_coarse = Divisor::at_least_one(settled.0 / COARSE);
    let share = settled_coarse.divide(coarse_squared(speed));
    let held = mul_div(FALL.0, share, settled_coarse);
    let next = speed + FALL - MicrometrePerSecond(held);
    match speed < settled {
        true => next.min(settled),
        false => next.max(settled),
    }
}

/// Square of a downward speed in coarse units.
fn coarse_squared(speed: MicrometrePerSecond) -> i32 {
    /// Largest speed whose square fits a word: 2.9 m/s.
    const FASTEST: i32 = 46_000;
    let coarse = (speed.0 / COARSE).min(FASTEST);
    coarse.wrapping_mul(coarse)
}

/// Additional stopping distance of a load that sinks at `speed`, beyond that of its valve.
///
/// It is the `f` for which `x + T v_s + f(v)` moves with the demanded speed: `f' v' = v_s - v`, and with the law above
/// near the steady speed `f = v^2 R / 4g`.
#[must_use]
pub fn free_fall_stopping_distance(speed: MicrometrePerSecond) -> Micrometre {
    Micrometre(FOUR_FALLS.divide(coarse_squared(speed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The law in small steps, m and s.
    fn fallen(mut speed: f64, settled: f64, time_s: f64) -> f64 {
        for _ in 0..10_000 {
            speed += 9.806_65 / 4.3 * (1.0 - (speed / settled).powi(2)) * time_s / 10_000.0;
        }
        speed
    }

    #[test]
    fn a_load_falls_as_the_law_says() {
        for (start, settled) in [
            (0, 200_000),
            (0, 50_000),
            (100_000, 60_000),
            (200_000, 150_000),
        ] {
            let mut speed = MicrometrePerSecond(start);
            for ms in 1..=100 {
                speed = next_speed(speed, MicrometrePerSecond(settled));
                let exact = fallen(
                    f64::from(start) * 1e-6,
                    f64::from(settled) * 1e-6,
                    f64::from(ms) * 1e-3,
                );
                let error = (f64::from(speed.0) * 1e-6 - exact).abs();
                assert!(error < 0.02 * f64::from(settled) * 1e-6, "{start}, {ms} ms");
            }
        }
    }

    #[test]
    fn a_shut_valve_holds_and_extremes_stay_finite() {
        for speed in [0, 1, 300_000, i32::MAX] {
            let speed = MicrometrePerSecond(speed);
            assert_eq!(
                next_speed(speed, MicrometrePerSecond::ZERO),
                MicrometrePerSecond::ZERO
            );
            for settled in [1, 300_000, i32::MAX] {
                assert!(
                    next_speed(speed, MicrometrePerSecond(settled)) >= MicrometrePerSecond::ZERO
                );
            }
        }
    }

    #[test]
    fn a_ramp_to_rest_ends_at_the_stopping_distance() {
        // The opening closes gently, without a spool's lag.
        let mut speed = MicrometrePerSecond(150_000);
        let expected = free_fall_stopping_distance(speed).0;
        let (mut way_nm, mut valve_nm) = (0, 0);
        for settled in (0..150_000).rev().step_by(250) {
            speed = next_speed(speed, MicrometrePerSecond(settled));
            way_nm += speed.0;
            valve_nm += settled;
        }
        let further = (way_nm - valve_nm) / 1000;
        assert!(
            (further - expected).abs() < expected / 6,
            "{further} um, not {expected}"
        );
    }
}
