//! What the end of a move says about the lag of the valve that made it.
//!
//! A hitch that runs on beyond the set point had a slower spool than the estimate takes it for; one that has to creep for
//! long had a faster one, and slowed down too early. Either way the lag was wrong by about the distance over the speed from
//! which the hitch was slowed down. Half of that is learnt, so that noise and odd moves average out.

use super::fixed::{Divisor, mul_div_seldom};
use super::units::{Micrometre, MicrometrePerSecond, Microsecond};

/// A move slower than this says nothing: it is all threshold.
const TELLING_SPEED: MicrometrePerSecond = MicrometrePerSecond(25_000);
/// Creeping that every move does.
const USUAL_CREEP: Micrometre = Micrometre(150);
/// Distance at rest that counts as none: what is left of the sensor's noise and of the load's swing.
const NOISE: Micrometre = Micrometre(150);
/// Most that one move teaches.
const MOST: Microsecond = Microsecond(10_000);

/// One move.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunOn {
    fastest: MicrometrePerSecond,
    crept_nm: i32,
}

impl RunOn {
    /// One step at the demanded `speed`, of which `creep` is the slowest.
    pub fn step(&mut self, speed: MicrometrePerSecond, creep: MicrometrePerSecond, slowing: bool) {
        self.fastest = self.fastest.max(speed);
        if slowing && speed <= creep {
            self.crept_nm = self.crept_nm.saturating_add(speed.0);
        }
    }

    /// The move is over, and the hitch rests `beyond` the set point: how much slower than assumed the spool was.
    #[must_use]
    pub fn lag_error(&self, beyond: Micrometre) -> Microsecond {
        if self.fastest < TELLING_SPEED {
            return Microsecond::ZERO;
        }
        let crept = Micrometre(Divisor::THOUSAND.divide(self.crept_nm));
        let short = (crept - USUAL_CREEP).max(Micrometre::ZERO);
        let further = match beyond > NOISE {
            true => beyond,
            false => -short,
        };
        // Half of um over um/s, in us.
        let fastest = Divisor::at_least_one(self.fastest.0);
        Microsecond(mul_div_seldom(further.0, 500_000, fastest)).limited(-MOST, MOST)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CREEP: MicrometrePerSecond = MicrometrePerSecond(6_400);

    /// Lag error in us of a move at `speed` um/s that creeps for `creep_ms` and ends `beyond_um` the set point.
    fn told(speed: i32, creep_ms: i32, beyond_um: i32) -> i32 {
        let mut run_on = RunOn::default();
        run_on.step(CREEP, CREEP, false);
        run_on.step(MicrometrePerSecond(speed), CREEP, true);
        (0..creep_ms).for_each(|_| run_on.step(CREEP, CREEP, true));
        run_on.lag_error(Micrometre(beyond_um)).0
    }

    #[test]
    fn half_of_the_distance_over_the_speed_is_learnt() {
        assert_eq!(told(100_000, 20, 0), 0, "every move creeps a little");
        assert_eq!(told(100_000, 20, 150), 0, "noise");
        assert_eq!(told(100_000, 20, 1_000), 5_000, "ran on by 1 mm");
        assert_eq!(told(100_000, 180, 0), -5_010, "crept for 1.15 mm");
        assert_eq!(told(100_000, 180, 1_000), 5_000, "running on counts first");
        assert_eq!(
            [told(30_000, 0, 9_000), told(30_000, 900, 0)],
            [10_000, -10_000],
            "at most"
        );
        assert_eq!(told(24_000, 900, 0), 0, "too slow a move");
    }
}
