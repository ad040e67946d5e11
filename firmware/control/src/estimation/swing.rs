//! Whether the load of this machine swings on its compensator, which asks for gentle ramps.
//!
//! A compensator that follows the load's pressure with a lag `T` takes `T p'` off the drop `d` that it keeps over the
//! lift valve. With the oil stiff and the load `M` accelerated by the pressure, `M v'' = A p'`, the speed no longer is
//! `v_0` of the opening:
//!
//! ```text
//! v = v_0 sqrt(1 - T p' / d)     so     v'' = K (1 - (v / v_0)^2),     K = A d / (M T)
//! ```
//!
//! That swings about `v_0`, hardly damped, at `sqrt(2 K / v_0)`: 2.7 Hz behind the open valve for 230 kg and 10 ms,
//! higher the less the valve is open. An edge of 40 ms makes the hitch half as fast again as its valve, and a valve
//! that closes meanwhile leaves it flying, since gravity is all that stops a load. What is opened and closed slowly
//! against that swing is followed without one.
//!
//! Such a machine is known by its start. Before anything flows its compensator has to come up from the pump's idle
//! pressure, then the speed grows with the square of the time: the hitch trails its lift valve ([`super::lag`]) by 14
//! ms or more beyond its lowering valve, which has no compensator. That is soon enough for braking the same move. A
//! valve that is off its curve may look the same once: on a short lift its whole way gives it away, else the gentle
//! moves that follow tell its lag, and a small one takes the suspicion back. So may a lift spool that is slower than the
//! lowering one: its load doesn't outrun the valve ([`super::outrun`]). A machine whose swing hides gives itself
//! away by where it comes to rest. A move that swung tells nothing of lags and offsets.
//!
//! ```text
//! Unseen --- trails by far ---> Noticed --- next move ---> Known
//!   ^ ^  \__ rests far beyond its set point __> Proven      |
//!   | +---- its whole way is short ---+                     |
//!   +----------------- trails like a spool -----------------+
//!
//! Noticed --- its load doesn't outrun its valve --> Acquitted --- rests far beyond its set point --> Proven
//! ```

use hitch_quantities::units::{MicrometrePerSecond, Millisecond};

use super::lag::Eighths;

/// What is known of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Swing {
    /// No sign of it yet.
    #[default]
    Unseen,
    /// Seen in the present move, which began with steep ramps.
    Noticed,
    /// Seen in an earlier one.
    Known,
    /// A lift came to rest far beyond its set point.
    Proven,
    /// What looked like one was a slow spool.
    Acquitted,
}

/// By how much the spools of one machine differ, with what offsets make of it: below is no swing.
const SPOOLS_DIFFER: Eighths = Eighths(8 * 12);

impl Swing {
    /// The present lift trails its valve by `lag` more than a lowering does; from `limit` on that is no spool's.
    pub fn notice(&mut self, lag: Eighths, limit: Eighths) {
        if *self == Self::Unseen && lag > limit {
            *self = Self::Noticed;
        }
    }

    /// Another move begins.
    pub fn begin(&mut self) {
        if *self == Self::Noticed {
            *self = Self::Known;
        }
    }

    /// A lift is over in which the load `outran` its valve, or didn't: then its lift spool is slow, and lifts that trail
    /// on no longer are suspicious.
    pub fn acquit(&mut self, outran: bool) {
        if *self == Self::Noticed && !outran {
            *self = Self::Acquitted;
        }
    }

    /// A lift is over: it trailed its valve by `seemed` more than a lowering does, and by `left` without what its whole
    /// way is short of. True if it tells of spool and offset; one that swung doesn't.
    ///
    /// A valve that opens late makes a short lift trail by half as much again as the `limit`, but with its whole way and
    /// not with its speed: next to nothing is left. What a swing is late by, it flies on with once the valve closes. That
    /// is proof, and gentle lifts mustn't take it back: in them a compensator that lags by 3 or 4 ms hardly shows.
    pub fn decide(&mut self, seemed: Eighths, left: Eighths, limit: Eighths) -> bool {
        let of_late_valve = limit + Eighths(limit.0 / 2);
        match *self {
            Self::Noticed if left > Eighths(limit.0 / 2) => *self = Self::Proven,
            Self::Noticed if seemed < of_late_valve && left < Eighths(limit.0 / 4) => {
                *self = Self::Unseen;
                return true;
            }
            Self::Noticed => {}
            _ => return true,
        }
        false
    }

    /// A gentle lift told that the hitch trails its valve by `lag` more than a lowering does.
    pub fn doubt(&mut self, lag: Eighths) {
        if *self == Self::Known && lag < SPOOLS_DIFFER {
            *self = Self::Unseen;
        }
    }

    /// A lift came to rest far beyond its set point.
    pub fn prove(&mut self) {
        *self = Self::Proven;
    }

    /// Something stood in the way of the present move: what it trailed by is no swing.
    pub fn obstruct(&mut self) {
        if *self == Self::Noticed {
            *self = Self::Unseen;
        }
    }

    /// True if ramps have to be gentle.
    #[must_use]
    pub fn is_seen(self) -> bool {
        !matches!(self, Self::Unseen | Self::Acquitted)
    }

    /// Time in which a difference between hitch and valve is blamed on the map while lifting at `speed`; `usual`
    /// without a swing.
    ///
    /// A bias that follows as fast as the load swings feeds the swing. That is slow behind an open valve; behind one
    /// that is nearly shut it is fast, and a wrong threshold has to be made up for there: a millisecond more for each
    /// mm/s.
    #[must_use]
    pub fn bias_time(self, usual: Millisecond, speed: MicrometrePerSecond) -> Millisecond {
        /// Furthest beyond the usual time: with 80 ms the bias follows in a sixth of a second.
        const MOST: i32 = 50;
        match self {
            Self::Unseen | Self::Acquitted => usual,
            _ => Millisecond(usual.0.saturating_add((speed.0 >> 10).clamp(0, MOST))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMIT: Eighths = Eighths(8 * 16);

    #[test]
    fn the_move_that_shows_a_swing_tells_nothing_and_the_next_ones_do() {
        let mut swing = Swing::default();
        swing.notice(LIMIT, LIMIT);
        assert_eq!(swing, Swing::Unseen, "a slow spool is no swing");
        swing.notice(Eighths(LIMIT.0 + 1), LIMIT);
        assert!(swing.is_seen());
        assert!(!swing.decide(LIMIT, Eighths(LIMIT.0 / 3), LIMIT), "swung");
        swing.begin();
        swing.notice(Eighths(0), LIMIT);
        assert_eq!(swing, Swing::Known);
        assert!(swing.decide(LIMIT, LIMIT, LIMIT), "was gentle");
        swing.obstruct();
        assert!(swing.is_seen(), "known from an earlier move");
    }

    #[test]
    fn a_gentle_move_takes_back_a_suspicion_but_no_proof() {
        for (mut swing, after) in [
            (Swing::Known, Swing::Unseen),
            (Swing::Proven, Swing::Proven),
        ] {
            swing.doubt(SPOOLS_DIFFER);
            assert!(swing.is_seen(), "trails too far for a spool");
            swing.doubt(Eighths(SPOOLS_DIFFER.0 - 1));
            assert_eq!(swing, after);
        }
        let mut swing = Swing::Noticed;
        swing.prove();
        swing.obstruct();
        assert_eq!(swing, Swing::Proven);
    }

    #[test]
    fn a_valve_that_opens_late_is_acquitted_and_a_swing_is_not() {
        let suspected = || {
            let mut swing = Swing::default();
            swing.notice(Eighths(LIMIT.0 + 1), LIMIT);
            swing
        };
        for (seemed_ms, left_ms, after) in [
            (20, -3, Swing::Unseen),
            (20, 6, Swing::Noticed),
            (20, 10, Swing::Proven),
            (40, -3, Swing::Noticed),
        ] {
            let mut swing = suspected();
            let tells = swing.decide(Eighths(8 * seemed_ms), Eighths(8 * left_ms), LIMIT);
            assert_eq!(tells, after == Swing::Unseen);
            assert_eq!(swing, after, "{seemed_ms} ms, {left_ms} ms left");
        }
        for extreme in [i32::MIN, i32::MAX].map(Eighths) {
            let mut known = suspected();
            known.begin();
            assert!(known.decide(extreme, extreme, extreme));
            assert_eq!(known, Swing::Known, "told by an earlier lift");
        }
    }

    #[test]
    fn a_load_that_did_not_outrun_its_valve_hangs_on_a_slow_spool_and_no_later_trail_is_suspicious()
    {
        let noticed = || {
            let mut swing = Swing::default();
            swing.notice(Eighths(LIMIT.0 + 1), LIMIT);
            swing
        };
        let mut swing = noticed();
        swing.acquit(true);
        assert_eq!(swing, Swing::Noticed, "outran");
        swing.acquit(false);
        assert!(swing.decide(LIMIT, LIMIT, LIMIT), "tells of its spool");
        swing.begin();
        swing.notice(Eighths(i32::MAX), LIMIT);
        assert!(!swing.is_seen());
        swing.prove();
        swing.acquit(false);
        assert_eq!(swing, Swing::Proven, "overshot all the same");
        let mut known = noticed();
        known.begin();
        known.acquit(false);
        assert_eq!(known, Swing::Known, "was gentle");
    }

    #[test]
    fn an_obstacle_is_no_swing() {
        let mut swing = Swing::default();
        swing.notice(Eighths(i32::MAX), LIMIT);
        swing.obstruct();
        assert_eq!(swing, Swing::Unseen);
    }

    #[test]
    fn only_a_hitch_that_swings_is_slow_to_blame_the_map() {
        let usual = Millisecond(30);
        let time = |swing: Swing, speed: i32| swing.bias_time(usual, MicrometrePerSecond(speed)).0;
        for speed in [i32::MIN, 0, 100_000, i32::MAX] {
            assert_eq!(time(Swing::Unseen, speed), 30);
        }
        assert_eq!(
            [i32::MIN, 0, 10_240, 100_000, i32::MAX].map(|speed| time(Swing::Known, speed)),
            [30, 30, 40, 80, 80]
        );
    }
}
