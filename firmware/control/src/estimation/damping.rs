//! Damps a load that swings on its oil while it is lifted.
//!
//! Oil and the air in it are a spring under the load, at 5 to 12 Hz, that hardly anything damps: a lift that begins
//! in 40 ms still swings when it has to stop, and where it comes to rest is then a matter of the moment. An outflow
//! that goes with the pressure would damp it, and a valve that is open for the lift can make one. With what the
//! load's speed `v` and the pressure `p` are off by, the oil's compliance `C`, and a demand `g v` that the spool
//! follows with its lag `T`:
//!
//! ```text
//! M v' = A p     C p' = A (u - v)     u + T u' = g v          w^2 = A^2 / (M C)
//! v'' = -w^2 (1 - g / (1 + j w T)) v          damping ratio:  g w T / (2 (1 + w^2 T^2))
//! ```
//!
//! So it is the spool's own lag that turns a demand which goes *with* the speed of the swing into one that is
//! against its pressure. The ratio is greatest where `w T` is one, and `g` = 1/2 makes it 0.12 there, and 0.08 at
//! 10 Hz behind 45 ms: in the two periods that braking takes, a third of the swing is left. What `g` is beyond that
//! feeds what the sensors see of noise and their lag.
//!
//! A load that swings on its compensator ([`super::swing`]) does it by what its valve gives, and more than twice as
//! slow: that is no swing to be damped so. Nor are lowering loads, whose valve lets more through the higher the
//! pressure is.

use hitch_quantities::units::MicrometrePerSecond;

/// The speed of the hitch, as soon as the sensor tells it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Damping {
    place_nm: i32,
    /// Nanometres a millisecond.
    speed: i32,
}

impl Damping {
    /// One step. The speed is smoothed over 8 and 4 ms: noise of 0.02 degree makes 2 mm/s of it, and a swing of 10 Hz
    /// is an eighth of its period late.
    pub fn step(&mut self, measured_nm: i32) {
        let speed = measured_nm.saturating_sub(self.place_nm) >> 3;
        self.place_nm = self.place_nm.saturating_add(speed);
        self.speed = self
            .speed
            .saturating_add(speed.saturating_sub(self.speed) >> 2);
    }

    /// What to ask the valve for beyond the `expected` speed, which is without the swing.
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
        let (mut damping, mut place_nm) = (Damping::default(), 0.0);
        // Speeds in um/s beyond the expected one.
        let (mut swing, mut acceleration, mut flow) = (0.0, 0.0, 0.0);
        let mut greatest = 0.0_f64;
        for step in 0..2_000 {
            if step == 500 {
                swing = 20_000.0;
            }
            damping.step(place_nm as i32);
            let demand = match damped {
                true => f64::from(damping.demand(SPEED).0),
                false => 0.0,
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
            place_nm += f64::from(SPEED.0) + swing;
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
