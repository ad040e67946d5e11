//! Time until a lowering hitch passes a threshold.
//!
//! The predicted stop of the hitch moves with exactly the demanded speed, and the hitch passes a point later than its
//! predicted stop by the lag `T` of the spool ([`crate::estimation::stop_prediction`]). The demanded speed rises from the
//! present one, `u`, at the slope `a` to a largest one, `p`, and falls before the set point at the slope `b` to the speed `w`
//! with which the hitch passes the threshold:
//!
//! ```text
//! t = (p - u) / a  +  r / p  +  2 c / (p + w)  +  T
//!
//! p^2 = (2 a b d + b u^2 + a w^2) / (a + b)    where both slopes meet, at most the speed of dial and valve
//! c   = (p^2 - w^2) / 2 b                      distance of braking
//! r   = d - (p^2 - u^2) / 2 a - c              distance at p;  d: from the predicted stop to the threshold
//! ```

use hitch_quantities::fixed::{Divisor, mul_div, square_root};
use hitch_quantities::units::{
    Micrometre, MicrometrePerSecond, MillimetrePerSecondSquared, Millisecond,
};

/// Half of a thousand: from the product of milliseconds with the sum of two speeds in um/s to the distance in um.
const TWO_THOUSAND: Divisor = Divisor::at_least_one(2_000);

/// A lowering move; distances and speeds are downward.
#[derive(Clone, Copy, Debug)]
pub struct Lowering {
    /// From the hitch to the threshold.
    pub distance: Micrometre,
    /// From the hitch to its predicted stop, at the lag `lag` of the spool.
    pub lag_distance: Micrometre,
    /// Lag of the spool.
    pub lag: Millisecond,
    /// Demanded speed.
    pub demanded: MicrometrePerSecond,
    /// Largest speed of dial and valve.
    pub largest: MicrometrePerSecond,
    /// Speed that the set point allows at the threshold.
    pub passing: MicrometrePerSecond,
    /// Slope of acceleration.
    pub acceleration: MillimetrePerSecondSquared,
    /// Slope of braking.
    pub deceleration: MillimetrePerSecondSquared,
}

impl Lowering {
    /// Time until the hitch passes the threshold.
    #[must_use]
    pub fn time(&self) -> Millisecond {
        let distance = self.distance - self.lag_distance;
        if distance <= Micrometre::ZERO {
            let lag_distance = Divisor::at_least_one(self.lag_distance.0);
            return Millisecond(mul_div(self.lag.0, self.distance.0, lag_distance));
        }
        let largest = self.largest.max(MicrometrePerSecond(1));
        let start = self.demanded.limited(MicrometrePerSecond::ZERO, largest);
        let end = self.passing.limited(MicrometrePerSecond::ZERO, largest);
        let peak = self
            .meeting(distance, start, end)
            .min(largest)
            .max(start)
            .max(end);
        let rises = slope_time(peak - start, self.acceleration);
        let falls = slope_time(peak - end, self.deceleration);
        let gone = |time: Millisecond, sum: MicrometrePerSecond| {
            Micrometre(mul_div(time.0, sum.0, TWO_THOUSAND))
        };
        let braking = gone(falls, peak + end).min(distance);
        let rest = distance - gone(rises, peak + start) - braking;
        let at = |distance: Micrometre, speed: MicrometrePerSecond| {
            let speed = Divisor::at_least_one(speed.0);
            Millisecond(mul_div(distance.max(Micrometre::ZERO).0, 1_000, speed))
        };
        rises + at(rest, peak) + at(braking + braking, peak + end) + self.lag
    }

    /// Speed at which the slopes from `start` and to `end` meet within a distance.
    fn meeting(
        &self,
        distance: Micrometre,
        start: MicrometrePerSecond,
        end: MicrometrePerSecond,
    ) -> MicrometrePerSecond {
        // Slopes have at most 15 bits, distances and speeds 21: the sum is below 2^63.
        let square = |speed: MicrometrePerSecond| {
            u64::from(speed.0.unsigned_abs()).saturating_mul(u64::from(speed.0.unsigned_abs()))
        };
        let up = u64::from(self.acceleration.0.unsigned_abs()).max(1);
        let down = u64::from(self.deceleration.0.unsigned_abs()).max(1);
        let twice = u64::from(distance.0.unsigned_abs()).saturating_mul(2_000);
        let sum = twice
            .saturating_mul(up)
            .saturating_add(square(start))
            .saturating_mul(down)
            .saturating_add(square(end).saturating_mul(up));
        let squared = sum.checked_div(up.saturating_add(down)).unwrap_or(0);
        MicrometrePerSecond(square_root(squared))
    }
}

/// Time in which a speed changes by this much.
fn slope_time(change: MicrometrePerSecond, slope: MillimetrePerSecondSquared) -> Millisecond {
    // 1 mm/s2 is 1 um/s a millisecond.
    Millisecond(Divisor::at_least_one(slope.0).divide(change.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOWERING: Lowering = Lowering {
        distance: Micrometre(50_000),
        lag_distance: Micrometre::ZERO,
        lag: Millisecond(40),
        demanded: MicrometrePerSecond::ZERO,
        largest: MicrometrePerSecond(60_000),
        passing: MicrometrePerSecond(200_000),
        acceleration: MillimetrePerSecondSquared(3_200),
        deceleration: MillimetrePerSecondSquared(850),
    };

    /// The move in steps of 10 us: a ramp, the braking profile `w^2 + 2 b r`, and a spool of first order.
    fn simulated_ms(of: &Lowering) -> f64 {
        const STEP_S: f64 = 1e-5;
        let um = f64::from;
        let (up, down) = (um(of.acceleration.0) * 1e3, um(of.deceleration.0) * 1e3);
        let lag_s = um(of.lag.0) * 1e-3;
        let (mut demanded, mut position, mut time_s) = (um(of.demanded.0), 0.0, 0.0);
        let mut speed = um(of.lag_distance.0) / lag_s;
        let end = um(of.passing.0).min(um(of.largest.0));
        while position < um(of.distance.0) {
            let left = (um(of.distance.0) - position - lag_s * speed).max(0.0);
            let most = (end * end + 2.0 * down * left).sqrt().min(um(of.largest.0));
            demanded = (demanded + up * STEP_S).min(most);
            speed += (demanded - speed) * STEP_S / lag_s;
            position += speed * STEP_S;
            time_s += STEP_S;
        }
        time_s * 1e3
    }

    #[test]
    fn it_is_the_time_of_a_simulated_move() {
        for (distance, demanded, lag_distance, passing) in [
            (50_000, 0, 0, 200_000),
            (50_000, 60_000, 2_400, 200_000),
            (2_000, 60_000, 2_400, 200_000),
            (50_000, 0, 0, 20_000),
            (400, 0, 0, 200_000),
            (3_000, 30_000, 1_000, 25_000),
        ] {
            let of = Lowering {
                distance: Micrometre(distance),
                demanded: MicrometrePerSecond(demanded),
                lag_distance: Micrometre(lag_distance),
                passing: MicrometrePerSecond(passing),
                ..LOWERING
            };
            let (found, exact) = (f64::from(of.time().0), simulated_ms(&of));
            assert!(
                (found - exact).abs() <= 0.02 * exact + 0.7 * f64::from(of.lag.0),
                "{found} ms, not {exact} ms: {of:?}"
            );
        }
    }

    #[test]
    fn extremes_stay_finite() {
        for word in [i32::MIN, -1, 0, 1, i32::MAX] {
            let of = Lowering {
                distance: Micrometre(word),
                lag_distance: Micrometre(-word.saturating_abs()),
                lag: Millisecond(word),
                demanded: MicrometrePerSecond(word),
                largest: MicrometrePerSecond(word),
                passing: MicrometrePerSecond(word),
                acceleration: MillimetrePerSecondSquared(word),
                deceleration: MillimetrePerSecondSquared(word),
            };
            let _ = of.time();
        }
    }
}
