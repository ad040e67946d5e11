//! Active damping of the load's oscillation on its oil during a lift.
//!
//! The oil and its air are a spring under the load, at 5 to 12 Hz, with hardly any damping. A lift that begins in 40 ms
//! still oscillates when it has to stop, so its rest position would depend on the phase of the oscillation. An outflow
//! proportional to the pressure damps it, and an open lift valve can produce one. With the deviations of load speed `v`
//! and pressure `p`, the oil compliance `C`, and a demand `g v` that the spool follows with its lag `T`:
//!
//! ```text
//! M v' = A p     C p' = A (u - v)     u + T u' = g v          w^2 = A^2 / (M C)
//! v'' = -w^2 (1 - g / (1 + j w T)) v          damping ratio:  g w T / (2 (1 + w^2 T^2))
//! ```
//!
//! The spool lag shifts the phase of the demand, so that positive feedback of the speed becomes negative feedback of
//! the pressure. The ratio is largest at `w T = 1`. A gain `g` of 1/2 gives 0.12 there, and 0.08 at 10 Hz with 45 ms: a
//! third of the amplitude remains after the two periods that braking takes. A larger gain amplifies sensor noise and
//! lag.
//!
//! An oscillation on the compensator ([`super::compensator_oscillation`]) is caused by the valve flow and has less than
//! half of that frequency; it is not damped by this law. A lowering load needs no damping: the flow of its valve rises
//! with the pressure.

use hitch_quantities::units::MicrometrePerSecond;

/// Measured speed of the hitch with a short filter.
#[derive(Clone, Copy, Debug, Default)]
pub struct Damping {
    position_nm: i32,
    /// Nanometres a millisecond.
    speed: i32,
}

impl Damping {
    /// One step. The speed is low-passed with 8 and 4 ms: noise of 0.02 degree gives 2 mm/s, and an oscillation of 10
    /// Hz is delayed by an eighth of its period.
    pub fn step(&mut self, measured_nm: i32) {
        let speed = measured_nm.saturating_sub(self.position_nm) >> 3;
        self.position_nm = self.position_nm.saturating_add(speed);
        self.speed = self
            .speed
            .saturating_add(speed.saturating_sub(self.speed) >> 2);
    }

    /// Speed correction; `expected`: speed without the oscillation.
    #[must_use]
    pub fn demand(&self, expected: MicrometrePerSecond) -> MicrometrePerSecond {
        MicrometrePerSecond(self.speed.saturating_sub(expected.0) >> 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::TAU;

    /// Share of a swing that is left after so many seconds, behind a valve with this lag.
    fn left(frequency_hz: f64, lag_s: f64, seconds: f64, damped: bool) -> f64 {
        const STEP_S: f64 = 1e-3;
        const SPEED: MicrometrePerSecond = MicrometrePerSecond(50_000);
        let squared = (TAU * frequency_hz).powi(2);
        let (mut damping, mut position_nm) = (Damping::default(), 0.0);
        // Speeds in um/s beyond the expected one.
        let (mut swing, mut acceleration, mut flow) = (0.0, 0.0, 0.0);
        let mut greatest = 0.0_f64;
        for step in 0..2_000 {
            if step == 500 {
                swing = 20_000.0;
            }
            damping.step(position_nm as i32);
            let demand = if damped {
                f64::from(damping.demand(SPEED).0)
            } else {
                0.0
            };
            if step == 499 {
                assert!(demand.abs() <= 4.0, "nothing swings yet: {demand}");
                flow = 0.0;
            }
            if step >= 499 {
                flow += (demand - flow) * STEP_S / lag_s;
                acceleration += squared * (flow - swing) * STEP_S;
                swing += acceleration * STEP_S;
            }
            position_nm += f64::from(SPEED.0) + swing;
            let at = f64::from(step) * STEP_S - 0.5 - seconds;
            if at.abs() < 0.5 / frequency_hz {
                greatest = greatest.max(swing.abs());
            }
        }
        greatest / 20_000.0
    }

    #[test]
    fn a_load_that_swings_on_its_oil_is_damped_by_whatever_spool() {
        for frequency_hz in [5.0, 7.0, 10.0, 12.0] {
            for lag_s in [0.030, 0.045, 0.055] {
                let [free, damped] =
                    [false, true].map(|damped| left(frequency_hz, lag_s, 0.3, damped));
                assert!(free > 0.95, "{frequency_hz} Hz, {lag_s} s: {free}");
                assert!(damped < 0.5, "{frequency_hz} Hz, {lag_s} s: {damped}");
            }
        }
    }

    #[test]
    fn a_hitch_that_goes_as_expected_asks_for_nothing_and_absurd_ones_do_no_harm() {
        let mut damping = Damping::default();
        for step in 0..200 {
            damping.step(step * 80_000);
        }
        assert!(damping.demand(MicrometrePerSecond(80_000)).0.abs() <= 4);
        assert!((damping.demand(MicrometrePerSecond(60_000)).0 - 10_000).abs() <= 4);
        for place in [i32::MAX, i32::MIN, i32::MIN, 0] {
            damping.step(place);
            let _ = damping.demand(MicrometrePerSecond(i32::MIN));
            let _ = damping.demand(MicrometrePerSecond(i32::MAX));
        }
    }
}
