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
use hitch_quantities::units::{Micrometre, MicrometrePerSecond, PerMille};

/// Standard gravity in um/s2, times the unit of the ratio in a calibration, in a millisecond.
const GRAVITY: i32 = 9_806_650;
/// Unit of squared speeds, um/s: the ECU then divides 32 bits instead of 64.
const COARSE: i32 = 64;

/// Gravity at the piston of a machine.
#[derive(Clone, Copy, Debug)]
pub struct FreeFall {
    /// `g / R` per millisecond.
    fall: MicrometrePerSecond,
}

impl FreeFall {
    /// That of a machine with the ratio `R`, the mean over its stroke.
    #[must_use]
    pub fn of(load_ratio: PerMille) -> Self {
        Self {
            fall: MicrometrePerSecond(Divisor::at_least_one(load_ratio.0).divide(GRAVITY)),
        }
    }

    /// Downward speed one millisecond after `speed`; `settled`: steady-state speed of the opening.
    #[must_use]
    pub fn next_speed(
        self,
        speed: MicrometrePerSecond,
        settled: MicrometrePerSecond,
    ) -> MicrometrePerSecond {
        if settled <= MicrometrePerSecond::ZERO {
            return MicrometrePerSecond::ZERO;
        }
        let settled_coarse = Divisor::at_least_one(settled.0 / COARSE);
        let share = settled_coarse.divide(coarse_squared(speed));
        let held = mul_div(self.fall.0, share, settled_coarse);
        let next = speed + self.fall - MicrometrePerSecond(held);
        if speed < settled {
            next.min(settled)
        } else {
            next.max(settled)
        }
    }

    /// Additional stopping distance of a load that sinks at `speed`, beyond that of its valve.
    ///
    /// It is the `f` for which `x + T v_s + f(v)` moves with the demanded speed: `f' v' = v_s - v`, and with the law above
    /// near the steady speed `f = v^2 R / 4g`.
    #[must_use]
    pub fn stopping_distance(self, speed: MicrometrePerSecond) -> Micrometre {
        // `4 g / R` in um/s2, in units of the square of a coarse speed.
        let four_falls =
            Divisor::at_least_one(self.fall.0.saturating_mul(1_000) / (COARSE * COARSE / 4));
        Micrometre(four_falls.divide(coarse_squared(speed)))
    }
}

/// Square of a downward speed in coarse units.
fn coarse_squared(speed: MicrometrePerSecond) -> i32 {
    /// Largest speed whose square fits a word: 2.9 m/s.
    const FASTEST: i32 = 46_000;
    let coarse = (speed.0 / COARSE).min(FASTEST);
    coarse.wrapping_mul(coarse)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ratios of the rig, of a long and of a short linkage.
    const RATIOS: [PerMille; 3] = [PerMille(4_300), PerMille(2_000), PerMille(8_000)];

    /// The law in small steps, m and s.
    fn fallen(ratio: PerMille, mut speed: f64, settled: f64, time_s: f64) -> f64 {
        let fall = 9.806_65e3 / f64::from(ratio.0);
        for _ in 0..10_000 {
            speed += fall * (1.0 - (speed / settled).powi(2)) * time_s / 10_000.0;
        }
        speed
    }

    #[test]
    fn a_load_falls_as_the_law_says() {
        for ratio in RATIOS {
            let fall = FreeFall::of(ratio);
            for (start, settled) in [
                (0, 200_000),
                (0, 50_000),
                (100_000, 60_000),
                (200_000, 150_000),
            ] {
                let mut speed = MicrometrePerSecond(start);
                for ms in 1..=100 {
                    speed = fall.next_speed(speed, MicrometrePerSecond(settled));
                    let exact = fallen(
                        ratio,
                        f64::from(start) * 1e-6,
                        f64::from(settled) * 1e-6,
                        f64::from(ms) * 1e-3,
                    );
                    let error = (f64::from(speed.0) * 1e-6 - exact).abs();
                    let limit = 0.03 * f64::from(settled.max(start)) * 1e-6;
                    assert!(error < limit, "{ratio:?}: {start}, {ms} ms: {error}");
                }
            }
        }
    }

    #[test]
    fn a_shut_valve_holds_and_extremes_stay_finite() {
        for ratio in [i32::MIN, 0, 1, 4_300, i32::MAX] {
            let fall = FreeFall::of(PerMille(ratio));
            for speed in [0, 1, 300_000, i32::MAX] {
                let speed = MicrometrePerSecond(speed);
                assert!(fall.stopping_distance(speed) >= Micrometre::ZERO);
                assert_eq!(
                    fall.next_speed(speed, MicrometrePerSecond::ZERO),
                    MicrometrePerSecond::ZERO
                );
                for settled in [1, 300_000, i32::MAX] {
                    let next = fall.next_speed(speed, MicrometrePerSecond(settled));
                    assert!(next >= MicrometrePerSecond::ZERO);
                }
            }
        }
    }

    #[test]
    fn a_ramp_to_rest_ends_at_the_stopping_distance() {
        for ratio in RATIOS {
            let fall = FreeFall::of(ratio);
            // The opening closes gently, without a spool's lag.
            let mut speed = MicrometrePerSecond(150_000);
            let expected = fall.stopping_distance(speed).0;
            let (mut way_nm, mut valve_nm) = (0, 0);
            for settled in (0..150_000).rev().step_by(125) {
                speed = fall.next_speed(speed, MicrometrePerSecond(settled));
                way_nm += speed.0;
                valve_nm += settled;
            }
            let further = (way_nm - valve_nm) / 1000;
            assert!(
                (further - expected).abs() < expected / 6,
                "{ratio:?}: {further} um, not {expected}"
            );
        }
    }
}
