//! When a hitch counts as started: from then on it owes what its valve gives, and its currents are no longer limited.

use super::*;

/// Where the coil comes on, thousandths of a degree.
const REST: i32 = 90_000;
/// Time in which averages of samples and of noise have settled, ms.
const SETTLED_MS: i32 = 200;

/// A sensor without noise on a hitch whose coil is on with a current that owes nothing.
struct Onset {
    rig: Rig,
    way: i32,
}

impl Onset {
    /// Along its coil's way the angle rises (1) or falls (-1).
    fn new(way: i32) -> Self {
        let mut onset = Self {
            rig: Rig::armed_at(REST),
            way,
        };
        (0..SETTLED_MS).for_each(|_| onset.step(Order::Rest, 0));
        onset.rest(0);
        onset
    }

    fn order(&self, lift: i32, lower: i32) -> Order {
        if self.way > 0 {
            Order::Lift(lift)
        } else {
            Order::Lower(lower)
        }
    }

    /// One step at a place along the way.
    fn step(&mut self, order: Order, along: i32) {
        let angle = MilliDegree(REST + self.way * along);
        self.rig
            .step_with(order, |inputs| inputs.rocker_angle = Some(angle));
        assert_eq!(self.rig.envelope.tripped(), None);
    }

    fn rest(&mut self, along: i32) {
        let order = self.order(1_326, 1_199);
        (0..SETTLED_MS).for_each(|_| self.step(order, along));
    }

    /// A command of all that the coils bear is held back until the hitch has started.
    fn has_started(mut self, along: i32) -> bool {
        let (lift, lower) = (SAFETY.lift_current_limit.0, SAFETY.lower_current_limit.0);
        self.step(self.order(lift, lower), along);
        !self.rig.envelope.holds_back()
    }
}

#[test]
fn more_travel_along_the_way_than_the_onset_travel_is_a_start() {
    let travel = SAFETY.onset_travel.0;
    for way in [1, -1] {
        for (along, starts) in [(0, false), (travel, false), (travel + 1, true)] {
            let mut onset = Onset::new(way);
            onset.rest(along);
            assert_eq!(onset.has_started(along), starts, "{way}: {along} mdeg");
        }
    }
}

/// Half of the samples whose mean is compared with the owed travel show a start: 8 ms.
#[test]
fn half_more_than_the_onset_travel_is_a_start_after_8_ms() {
    let along = SAFETY.onset_travel.0 * 3 / 2;
    for way in [1, -1] {
        let mut onset = Onset::new(way);
        let order = onset.order(1_326, 1_199);
        (0..7).for_each(|_| onset.step(order, along));
        assert!(onset.has_started(along), "{way}");
    }
}

#[test]
fn a_hitch_that_creeps_along_has_started() {
    for way in [1, -1] {
        let mut onset = Onset::new(way);
        let order = onset.order(1_326, 1_199);
        // 2 degrees a second.
        for ms in 1..=500 {
            onset.step(order, 2 * ms);
        }
        assert!(onset.has_started(1_000), "{way}");
    }
}

#[test]
fn a_hitch_that_first_goes_back_starts_from_there() {
    let travel = SAFETY.onset_travel.0;
    let rise = travel + travel / 2;
    for way in [1, -1] {
        for (back, starts) in [(travel, false), (travel + 1, true), (900, true)] {
            let mut onset = Onset::new(way);
            onset.rest(-back);
            onset.rest(rise - back);
            assert_eq!(onset.has_started(rise - back), starts, "{way}: {back}");
        }
    }
}
