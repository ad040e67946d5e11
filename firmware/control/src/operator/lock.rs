//! The start-up lock: nothing moves until the lever has been moved through the present position.
//!
//! A machine that was switched off with the lever elsewhere must not move when it is switched on. The
//! operator picks the hitch up: the lever has to be *moving* and has to pass the hitch, or come close.

use hitch_quantities::calibration::design_parameters::LockParameters;
use hitch_quantities::units::{MilliDegree, Millisecond};

/// The lock; made anew each time it falls shut.
#[derive(Clone, Copy, Debug, Default)]
pub struct StartLock {
    /// Where the lever was when the present look at its movement began, and how long ago.
    look: Option<(MilliDegree, Millisecond)>,
}

impl StartLock {
    /// One step with lever and hitch; true once the hitch has been picked up.
    pub fn picked_up(
        &mut self,
        lever: MilliDegree,
        hitch: MilliDegree,
        parameters: &LockParameters,
    ) -> bool {
        let (reference, age) = match self.look {
            Some((reference, age)) if age < parameters.lever_time => (reference, age.next()),
            _ => (lever, Millisecond::ZERO),
        };
        self.look = Some((reference, age));
        let moving = (lever - reference).magnitude() >= parameters.lever_movement;
        let close = (lever - hitch).magnitude() <= parameters.pick_up_window;
        let passed = (reference < hitch) != (lever < hitch);
        moving && (close || passed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARAMETERS: LockParameters = LockParameters::NOMINAL;
    const HITCH: MilliDegree = MilliDegree(90_000);

    fn unlocks(levers: impl IntoIterator<Item = i32>) -> bool {
        let mut lock = StartLock::default();
        levers
            .into_iter()
            .any(|lever| lock.picked_up(MilliDegree(lever), HITCH, &PARAMETERS))
    }

    #[test]
    fn a_lever_at_rest_unlocks_nothing_wherever_it_is() {
        for lever in (40_000..140_000).step_by(100) {
            assert!(!unlocks(core::iter::repeat_n(lever, 5_000)));
        }
    }

    #[test]
    fn noise_on_a_lever_that_lies_at_the_hitch_is_no_movement() {
        assert!(!unlocks(
            (0..10_000).map(|step| 90_000 + (step * 7919) % 601 - 300)
        ));
    }

    #[test]
    fn a_lever_that_moves_elsewhere_unlocks_nothing() {
        assert!(!unlocks((0..3_000).map(|step| 100_000 + step * 10)));
    }

    #[test]
    fn a_lever_that_creeps_through_the_hitch_unlocks_nothing() {
        assert!(!unlocks((0..13_000).map(|step| 70_000 + step * 3)));
    }

    #[test]
    fn passing_the_hitch_unlocks_from_both_sides_at_any_hand_speed() {
        for speed in [4, 5, 50, 500, 20_000] {
            let steps = 40_000 / speed;
            assert!(
                unlocks((0..=steps).map(|step| 70_000 + step * speed)),
                "up, {speed} mdeg/ms"
            );
            assert!(
                unlocks((0..=steps).map(|step| 110_000 - step * speed)),
                "down, {speed} mdeg/ms"
            );
        }
    }
}
