//! Position control: from the distance that remains to the piston speed that is right now.
//!
//! The controlled point is where the hitch would come to rest ([`RunOn::resting_point`]); it moves with
//! exactly the demanded speed, so any speed profile that falls to zero with the distance `r` arrives
//! without overshoot. This one decelerates at a constant `a`, and for the last bit in proportion:
//!
//! ```text
//! u(r) = k r                        r <= a / k^2
//! u(r) = sqrt(2 a (r - a / 2k^2))   beyond; value and slope meet
//! ```
//!
//! It never asks for less than a creep speed: the end of the approach is then a cut of the coil, at the
//! moment from which the closing spool carries the hitch onto the set point ([`RunOn::cut_point`]). A load that is
//! stopped at a speed `v` swings on by `v / w` of its frequency on the oil, so that is slow: all of it is within the
//! half degree in which the move is over, and costs no time. A hitch that came to rest elsewhere is brought there at some
//! times that speed.
//!
//! A load that swings back before its coil is cut seems to have some way left. A valve that opens for that once more
//! gives the next swing its flow, and carries the hitch beyond: what has slowed down to its end stays slow.
//!
//! A spool whose play was taken up while it slowed down, and that friction then holds back, needs the current of the
//! way up again to move any further. At its slowest a move isn't worth that: a hitch may stand a tenth of a degree away
//! from where its coil would be cut, and stay there with the coil on. So the band in which it is cut gets wider when
//! the end takes long.

use hitch_quantities::Calibration;
use hitch_quantities::calibration::design_parameters::PositionParameters;
use hitch_quantities::fixed::{Divisor, mul_div, square_root};
use hitch_quantities::units::{
    Micrometre, MicrometrePerSecond, MilliDegree, MillimetrePerSecondSquared, Millisecond,
    PerSecond,
};

use crate::estimation::motion::{Motion, RunOn};
use crate::valve::closing::Closing;
use crate::valve::drop_scale::DropScale;
use crate::valve::phase::{Demand, Direction, Phase};

/// A correction goes so many times as fast as the slowest approach: a whole one at that speed would take seconds.
const CORRECTION: i32 = 3;
/// ... and a move that has slowed down so far doesn't get faster again: half of a millimetre is left then.
const END: i32 = 6;
/// A move that has been at its end for so long isn't waited for ...
const PATIENCE: Millisecond = Millisecond(110);
/// ... each millisecond from then on it is spared so much of its way, um: half of what it should go at its slowest ...
const SPARED: i32 = 2;
/// ... but no more than this: with the stop band that makes 0.17 degree.
const MOST_SPARED: i32 = 130;

/// Follows the lever.
#[derive(Clone, Copy, Debug, Default)]
pub struct PositionControl {
    set_point: Option<MilliDegree>,
    /// The set point that all of what follows is about: the one in use is within the dead band of it.
    asked: MilliDegree,
    /// The hitch has rested at this set point: leaving it now is its own doing.
    arrived: bool,
    /// A move to this set point has begun: another one is a correction.
    started: bool,
    /// The present move is one, for the move itself ended elsewhere.
    retries: bool,
    /// For how long the present move has been at its end: since it had slowed down to it.
    ending: Millisecond,
    /// The present place is taken for the set point until the lever moves (end stop).
    accepted: bool,
}

/// Why a resting hitch moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The lever was moved.
    SetPoint,
    /// The hitch left its place by itself.
    Drift,
}

impl PositionControl {
    /// Takes in the lever, and the limit that caps it; true if that is a new set point.
    ///
    /// On the way to a set point every movement of the lever counts, but small ones make no new set point of it: what
    /// the hitch does then is still about the same one. Once it has arrived, they are noise, also while it is being
    /// brought back.
    pub fn follow(
        &mut self,
        lever: MilliDegree,
        upper_limit: MilliDegree,
        moving: bool,
        parameters: &PositionParameters,
    ) -> bool {
        let lever = lever.limited(parameters.lower_limit, upper_limit);
        let changed = self.set_point.is_none()
            || (lever - self.asked).magnitude() > parameters.lever_deadband;
        if changed {
            *self = Self {
                set_point: Some(lever),
                asked: lever,
                ..Self::default()
            };
        } else if moving && !self.arrived {
            self.set_point = Some(lever);
        }
        changed
    }

    /// The set point inside the limits; `otherwise` before there was one.
    #[must_use]
    pub fn set_point(&self, otherwise: MilliDegree) -> MilliDegree {
        self.set_point.unwrap_or(otherwise)
    }

    /// Takes the present place for the set point until the lever moves.
    pub fn accept(&mut self) {
        self.accepted = true;
    }

    /// True if the hitch has rested at the set point: where it is now, it went by itself.
    #[must_use]
    pub const fn has_arrived(&self) -> bool {
        self.arrived
    }

    /// The reason for which a resting hitch should move to `target`, if there is one.
    pub fn reason_to_move(
        &mut self,
        target: Micrometre,
        rest: Micrometre,
        parameters: &PositionParameters,
    ) -> Option<Reason> {
        if self.accepted || (target - rest).magnitude() <= parameters.restart_band {
            self.arrived = true;
            return None;
        }
        Some(self.reason())
    }

    /// A move starts now: for this reason.
    pub fn start(&mut self) -> Reason {
        let reason = self.reason();
        self.retries = self.started && !self.arrived;
        self.started = true;
        self.ending = Millisecond::ZERO;
        reason
    }

    const fn reason(&self) -> Reason {
        if self.arrived || self.started {
            Reason::Drift
        } else {
            Reason::SetPoint
        }
    }

    /// The demand of a hitch that moves, or has a reason to, towards `target`.
    #[must_use]
    pub fn demand(
        &self,
        target: Micrometre,
        phase: Phase,
        motion: &Motion,
        closing: &Closing,
        scale: DropScale,
        calibration: &Calibration,
    ) -> Demand {
        let parameters = &calibration.position;
        let direction = match phase {
            Phase::Moving { direction, .. } => direction,
            _ => Direction::of((target - motion.position()).0),
        };
        let (limit, acceleration, deceleration) = match direction {
            Direction::Lift if motion.swings() => (
                parameters.lift_speed,
                parameters.swinging_acceleration,
                parameters.swinging_deceleration,
            ),
            Direction::Lift => (
                parameters.lift_speed,
                parameters.lift_acceleration,
                parameters.lift_deceleration,
            ),
            Direction::Lower => (
                parameters.lower_speed,
                scale.ramp_at_present(parameters.lower_acceleration),
                scale.ramp_at_present(parameters.lower_deceleration),
            ),
        };
        let ahead_of = |point: Micrometre| Micrometre(direction.sign((target - point).0));
        let run_on: RunOn = motion.run_on(&calibration.hydraulics);
        let remaining = ahead_of(run_on.resting_point());
        // A cut carries less far than a ramp to zero, so it needn't be looked at before that would do.
        let band = parameters.stop_band + self.spared();
        let cut =
            remaining <= band && ahead_of(run_on.cut_point(motion.share_of_cut(closing))) <= band;
        let approach = approach_speed(remaining, deceleration, parameters.approach_gain);
        let speed = match cut {
            true => MicrometrePerSecond::ZERO,
            false => approach.max(parameters.creep_speed).min(limit),
        };
        Demand {
            direction,
            speed,
            acceleration,
        }
    }

    /// How much of the way the present move is spared, for it has been at its end for long.
    fn spared(&self) -> Micrometre {
        let since = (self.ending - PATIENCE).0.clamp(0, MOST_SPARED / SPARED);
        Micrometre(since.wrapping_mul(SPARED))
    }

    /// The `demand`, but slow once the move has slowed down to its end, and creeping if the last one didn't get there.
    ///
    /// What sent that one elsewhere the estimate doesn't know, and a short way doesn't tell in time: in a hurry this one
    /// would end as far beyond, and the next one as well. What leaves its place after it has rested there didn't err.
    /// `lower_speed`: the fastest lowering that the operator allows.
    #[must_use]
    pub fn paced(
        &mut self,
        mut demand: Demand,
        lower_speed: MicrometrePerSecond,
        parameters: &PositionParameters,
    ) -> Demand {
        // A dial that is nearly shut is no end: it may be opened during the move.
        let by_dial = demand.direction == Direction::Lower && demand.speed >= lower_speed;
        if by_dial {
            demand.speed = lower_speed;
        }
        let slow = !by_dial && demand.speed <= creeping(END, parameters);
        if slow || self.ending > Millisecond::ZERO {
            self.ending = self.ending.next();
        }
        let times = match (self.retries, self.ending > Millisecond::ZERO) {
            (true, _) => CORRECTION,
            (false, true) => END,
            (false, false) => return demand,
        };
        demand.speed = demand.speed.min(creeping(times, parameters));
        demand
    }
}

/// So many times as fast as the slowest approach.
fn creeping(times: i32, parameters: &PositionParameters) -> MicrometrePerSecond {
    MicrometrePerSecond(parameters.creep_speed.0.saturating_mul(times))
}

/// The profile `u(r)` of the module's head.
#[must_use]
pub fn approach_speed(
    remaining: Micrometre,
    deceleration: MillimetrePerSecondSquared,
    gain: PerSecond,
) -> MicrometrePerSecond {
    let remaining = remaining.max(Micrometre::ZERO);
    let gain_squared = Divisor::at_least_one(gain.0.saturating_mul(gain.0));
    let linear = Micrometre(mul_div(deceleration.0, 1000, gain_squared));
    if remaining <= linear {
        return MicrometrePerSecond(remaining.0.saturating_mul(gain.0));
    }
    let beyond = remaining - Micrometre(Divisor::at_least_one(2).divide(linear.0));
    // 2 a r in um2/s2, with a in 1000 um/s2: below 2^32 * 2^15 * 2000 = 2^58.
    let twice = u64::from(deceleration.0.unsigned_abs()).saturating_mul(2000);
    MicrometrePerSecond(square_root(
        twice.saturating_mul(u64::from(beyond.0.unsigned_abs())),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::valve::drop_scale::DropReference;

    #[test]
    fn the_profile_is_the_constant_deceleration_it_says() {
        let (deceleration, gain) = (MillimetrePerSecondSquared(1_200), PerSecond(20));
        let mut last = MicrometrePerSecond::ZERO;
        for remaining in 0..200_000 {
            let speed = approach_speed(Micrometre(remaining), deceleration, gain);
            assert!(speed >= last, "falls at {remaining} um");
            let (r, a, k) = (f64::from(remaining) * 1e-6, 1.2, 20.0);
            let exact = if r <= a / (k * k) {
                k * r
            } else {
                (2.0 * a * (r - a / (2.0 * k * k))).sqrt()
            };
            assert!(
                (f64::from(speed.0) * 1e-6 - exact).abs() < 1e-4 * exact + 2e-6,
                "{remaining} um"
            );
            last = speed;
        }
    }

    #[test]
    fn cutting_the_coil_at_the_slowest_approach_leaves_a_load_on_aerated_oil_where_it_is() {
        // A load that is stopped at once swings on by its speed over its frequency; 1.75 mm are a degree.
        const SOFTEST_HZ: f64 = 5.0;
        let creep_mm_per_s = f64::from(PositionParameters::NOMINAL.creep_speed.0) * 1e-3;
        let swing_mm = creep_mm_per_s / (core::f64::consts::TAU * SOFTEST_HZ);
        assert!(swing_mm / 1.75 <= 0.1, "{swing_mm} mm");
    }

    #[test]
    fn a_move_that_ended_elsewhere_is_made_good_slowly_but_not_as_slowly_as_a_move_ends() {
        let parameters = PositionParameters::NOMINAL;
        let (fast, creep) = (parameters.lift_speed, creeping(CORRECTION, &parameters));
        assert!(creep > parameters.creep_speed && creep.0 < fast.0 / 10);
        let demand = Demand {
            direction: Direction::Lift,
            speed: fast,
            acceleration: parameters.lift_acceleration,
        };
        let mut position = PositionControl::default();
        let mut moved = |reason, rests| {
            assert_eq!(position.start(), reason);
            if rests {
                let here = Micrometre::ZERO;
                assert_eq!(position.reason_to_move(here, here, &parameters), None);
            }
            position.paced(demand, fast, &parameters).speed
        };
        assert_eq!(moved(Reason::SetPoint, false), fast);
        assert_eq!(moved(Reason::Drift, true), creep, "ended elsewhere");
        assert_eq!(moved(Reason::Drift, false), fast, "left its place");
    }

    #[test]
    fn a_move_that_has_slowed_down_to_its_end_stays_slow_until_the_next_one() {
        let parameters = PositionParameters::NOMINAL;
        let (fast, end) = (parameters.lift_speed, creeping(END, &parameters));
        let paced = |position: &mut PositionControl, speed| {
            let demand = Demand {
                direction: Direction::Lift,
                speed,
                acceleration: parameters.lift_acceleration,
            };
            position.paced(demand, fast, &parameters).speed
        };
        let (low, high) = (MilliDegree(80_000), MilliDegree(90_000));
        let mut position = PositionControl::default();
        position.follow(low, parameters.upper_limit, false, &parameters);
        position.start();
        for speed in [fast, end + MicrometrePerSecond(1), fast] {
            assert_eq!(paced(&mut position, speed), speed, "under way");
        }
        let slow = parameters.creep_speed;
        for (asked, given) in [(end, end), (fast, end), (slow, slow), (fast, end)] {
            assert_eq!(paced(&mut position, asked), given);
        }
        position.follow(high, parameters.upper_limit, true, &parameters);
        assert_eq!(paced(&mut position, fast), fast, "another set point");
        assert_eq!(paced(&mut position, end), end);
        let here = Micrometre::ZERO;
        assert_eq!(position.reason_to_move(here, here, &parameters), None);
        position.start();
        assert_eq!(paced(&mut position, fast), fast, "another move");
    }

    /// For how long a hitch that stands still `short_of` where its coil is cut is waited for, ms.
    fn waited_for(position: &mut PositionControl, short_of: Micrometre) -> Option<i32> {
        let calibration = Calibration::nominal();
        let parameters = &calibration.position;
        let closing = Closing::of(&calibration);
        let drop = calibration.hydraulics.reference_drop;
        let scale = DropScale::new(&DropReference::new(drop), drop);
        let mut motion = Motion::default();
        motion.update(Micrometre::ZERO, Phase::Holding, &calibration.motion);
        let phase = Phase::Moving {
            direction: Direction::Lift,
            speed: parameters.creep_speed,
        };
        let target = parameters.stop_band + short_of;
        (0..2_000).find(|_| {
            let demand = position.demand(target, phase, &motion, &closing, scale, &calibration);
            let demand = position.paced(demand, parameters.lower_speed, parameters);
            demand.speed == MicrometrePerSecond::ZERO
        })
    }

    #[test]
    fn a_hitch_that_stands_just_short_of_its_set_point_is_not_waited_for() {
        let mut position = PositionControl::default();
        position.start();
        assert_eq!(waited_for(&mut position, Micrometre::ZERO), Some(0));
        for (short_of, longest_ms) in [(20, 120), (MOST_SPARED, 180)] {
            position.start();
            let waited_ms = waited_for(&mut position, Micrometre(short_of)).unwrap();
            assert!((100..=longest_ms).contains(&waited_ms), "{waited_ms} ms");
        }
        position.start();
        assert_eq!(waited_for(&mut position, Micrometre(MOST_SPARED + 1)), None);
    }

    #[test]
    fn a_load_that_swings_back_at_the_end_of_a_move_is_waited_for_no_longer() {
        let parameters = PositionParameters::NOMINAL;
        let demand = |speed| Demand {
            direction: Direction::Lift,
            speed,
            acceleration: parameters.lift_acceleration,
        };
        let mut position = PositionControl::default();
        position.start();
        let end = creeping(END, &parameters);
        let _ = position.paced(demand(end), parameters.lower_speed, &parameters);
        for _ in 0..PATIENCE.0 {
            let fast = demand(parameters.lift_speed);
            let _ = position.paced(fast, parameters.lower_speed, &parameters);
        }
        let waited_ms = waited_for(&mut position, Micrometre(20)).unwrap();
        assert!(waited_ms <= 10, "{waited_ms} ms more");
    }

    #[test]
    fn a_hitch_that_goes_on_at_its_slowest_gets_where_it_should() {
        let way_per_ms = PositionParameters::NOMINAL.creep_speed.0 / 1_000;
        assert!(SPARED < way_per_ms, "is given up sooner than it goes");
        let end_mm_per_s = creeping(END, &PositionParameters::NOMINAL).0 / 1_000;
        let at_end_um = 1_000 * end_mm_per_s / PositionParameters::NOMINAL.approach_gain.0;
        let slowest_um = at_end_um - PositionParameters::NOMINAL.stop_band.0;
        assert!(slowest_um / way_per_ms <= PATIENCE.0, "{slowest_um} um");
    }

    #[test]
    fn a_lowering_dial_that_is_opened_during_a_move_is_obeyed() {
        let parameters = PositionParameters::NOMINAL;
        let mut position = PositionControl::default();
        position.start();
        let mut paced = |speed, dial| {
            let demand = Demand {
                direction: Direction::Lower,
                speed,
                acceleration: parameters.lower_acceleration,
            };
            position.paced(demand, dial, &parameters).speed
        };
        let (fast, end) = (parameters.lower_speed, creeping(END, &parameters));
        for dial in [MicrometrePerSecond::ZERO, parameters.creep_speed, end, fast] {
            assert_eq!(paced(dial, dial), dial);
        }
        assert_eq!(paced(end, fast), end, "its end");
        assert_eq!(paced(fast, fast), end);
    }

    #[test]
    fn extreme_arguments_stay_finite() {
        for remaining in [i32::MIN, -1, 0, 1, i32::MAX] {
            for gain in [1, 200] {
                let speed = approach_speed(
                    Micrometre(remaining),
                    MillimetrePerSecondSquared(20_000),
                    PerSecond(gain),
                );
                assert!(speed >= MicrometrePerSecond::ZERO);
            }
        }
    }
}
