//! Arbiter of the set point: the operator's lever, or an implement that commands the hitch over the bus.
//!
//! ```text
//!             an implement takes control (see `j1939::remote`)
//!  +-------+ -------------------------------------------------> +-----------+
//!  | Lever |                                                    | Implement |
//!  +-------+ <-----------------+ lever left where it was        +-----------+
//!      ^                       |                                  |
//!      |  one step of hold   +------+  lever moved, button        |
//!      +---------------------| Stop | <---------------------------+
//!                            +------+  pressed, or remote control ended
//! ```
//!
//! After remote control the lever is usually not at the hitch position. The return of control therefore includes a step
//! of hold: it activates the start-up lock of the controller, and the hitch stays until the lever capture.

use hitch_protocols::j1939::Remote;
use hitch_quantities::Inputs;
use hitch_quantities::calibration::design_parameters::PositionParameters;
use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{MilliDegree, PerMille};

/// Lever motion that ends remote control: 0.8 % of the range, as for the start-up lock.
const TAKEN: MilliDegree = MilliDegree(730);
const WHOLE: Divisor = Divisor::THOUSAND;

/// The arbiter.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arbiter {
    /// Position of the lever when the implement took control.
    lever: Option<MilliDegree>,
    overridden: bool,
}

impl Arbiter {
    /// The inputs for the controller.
    #[must_use]
    pub fn decide(
        &mut self,
        inputs: Inputs,
        remote: Remote,
        limits: &PositionParameters,
    ) -> Inputs {
        // A faulty lever is handled by the controller.
        let Some(lever) = inputs.lever else {
            return inputs;
        };
        match (remote, self.lever) {
            (Remote::Idle, None) => {
                self.overridden = false;
                inputs
            }
            (Remote::Idle, Some(_)) => {
                self.lever = None;
                held(inputs)
            }
            (Remote::Position(position), taken_at) => {
                let taken_at = *self.lever.insert(taken_at.unwrap_or(lever));
                self.overridden |= (lever - taken_at).magnitude() > TAKEN || inputs.jog.is_some();
                if self.overridden {
                    held(inputs)
                } else {
                    Inputs {
                        set_point: Some(angle(position, limits)),
                        ..inputs
                    }
                }
            }
        }
    }

    /// Whether the operator has taken control and the implement has not yet acknowledged it.
    #[must_use]
    pub const fn is_overridden(&self) -> bool {
        self.overridden
    }
}

fn held(mut inputs: Inputs) -> Inputs {
    inputs.switches.hold = true;
    inputs
}

/// The angle of a position between the limits of the travel.
fn angle(position: PerMille, limits: &PositionParameters) -> MilliDegree {
    let travel = limits.upper_limit - limits.lower_limit;
    limits.lower_limit + travel.scaled(position.0, WHOLE)
}

/// The position of an angle between the limits of the travel.
#[must_use]
pub fn position(angle: MilliDegree, limits: &PositionParameters) -> PerMille {
    let travel = (limits.upper_limit - limits.lower_limit).0;
    let above = angle - limits.lower_limit;
    let share = above.scaled(1_000, Divisor::at_least_one(travel));
    PerMille(share.0).limited(PerMille::ZERO, PerMille(1_000))
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: PositionParameters = PositionParameters::NOMINAL;

    fn at(lever: i32) -> Inputs {
        Inputs {
            lever: Some(MilliDegree(lever)),
            ..Inputs::default()
        }
    }

    #[test]
    fn a_position_goes_round_by_way_of_its_angle() {
        for per_mille in 0..=1_000 {
            let angle = angle(PerMille(per_mille), &LIMITS);
            assert_eq!(position(angle, &LIMITS), PerMille(per_mille));
        }
        assert_eq!(position(MilliDegree(0), &LIMITS), PerMille(0));
        assert_eq!(position(MilliDegree(200_000), &LIMITS), PerMille(1_000));
    }

    #[test]
    fn a_moved_lever_takes_the_hitch_back_and_keeps_it() {
        let mut arbiter = Arbiter::default();
        let remote = Remote::Position(PerMille(1_000));
        let given = arbiter.decide(at(60_000), remote, &LIMITS);
        assert_eq!(given.set_point, Some(LIMITS.upper_limit));
        assert_eq!(
            given.lever,
            at(60_000).lever,
            "the lever stays the operator's"
        );
        let nudged = arbiter.decide(at(60_000 + TAKEN.0), remote, &LIMITS);
        assert_eq!(
            nudged.set_point,
            Some(LIMITS.upper_limit),
            "as far as noise goes"
        );
        let moved = arbiter.decide(at(60_001 + TAKEN.0), remote, &LIMITS);
        assert!(moved.switches.hold && arbiter.is_overridden());
        let back = arbiter.decide(at(60_000), remote, &LIMITS);
        assert!(back.switches.hold, "until the implement has lost control");
        assert!(
            arbiter
                .decide(at(60_000), Remote::Idle, &LIMITS)
                .switches
                .hold
        );
        assert_eq!(
            arbiter.decide(at(60_000), Remote::Idle, &LIMITS),
            at(60_000)
        );
    }

    #[test]
    fn an_implement_that_falls_silent_leaves_a_locked_hitch() {
        let mut arbiter = Arbiter::default();
        let _ = arbiter.decide(at(60_000), Remote::Position(PerMille(500)), &LIMITS);
        let after = arbiter.decide(at(60_000), Remote::Idle, &LIMITS);
        assert!(after.switches.hold);
        assert_eq!(
            arbiter.decide(at(60_000), Remote::Idle, &LIMITS),
            at(60_000)
        );
    }

    #[test]
    fn a_broken_lever_is_not_hidden() {
        let mut arbiter = Arbiter::default();
        let remote = Remote::Position(PerMille(500));
        assert_eq!(
            arbiter.decide(Inputs::default(), remote, &LIMITS),
            Inputs::default()
        );
    }
}
