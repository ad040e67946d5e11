//! Operator inputs besides the lever: engine, rate dial, quick lift, quick engagement and float.

pub mod button;
pub mod engage;
pub mod lever;
pub mod lock;
pub mod mode;

use hitch_quantities::calibration::design_parameters::{
    LockParameters, OperatorParameters, PositionParameters,
};
use hitch_quantities::fixed::interpolate;
use hitch_quantities::units::{
    MicrometrePerSecond, MilliDegree, Millisecond, PerMille, RevolutionPerMinute,
};

/// Monitors whether the engine has been running for long enough.
#[derive(Clone, Copy, Debug, Default)]
pub struct EngineWatch {
    running_for: Millisecond,
    /// The engine speed has been received: from then on a missing value counts as a stopped engine.
    was_known: bool,
}

impl EngineWatch {
    /// One step; true if the hitch may be used. A machine that has never received an engine speed may be used, unless
    /// the calibration requires the speed.
    pub fn permits(
        &mut self,
        speed: Option<RevolutionPerMinute>,
        parameters: &LockParameters,
    ) -> bool {
        self.was_known |= speed.is_some();
        let Some(speed) = speed else {
            self.running_for = Millisecond::ZERO;
            return !self.was_known && parameters.engine_required.0 == 0;
        };
        let runs = speed > parameters.engine_running;
        let running_for = self.running_for.counted_while(runs);
        self.running_for = running_for.min(parameters.engine_settling);
        self.running_for >= parameters.engine_settling && runs
    }
}

/// Quick lift: one press raises the hitch, the next returns it to the lever.
///
/// ```text
///            press                 press, or anything that ends position control
/// +-------+ ------> +--------+ ---------------------------------------------------+
/// | Lever |         | Raised |                                                    |
/// +-------+ <------ +--------+ <--------------------------------------------------+
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct QuickLift {
    raised: bool,
    pressed: bool,
}

impl QuickLift {
    /// One step with the button; `follows_lever`: the controller is in position control.
    pub fn press(&mut self, pressed: bool, follows_lever: bool) {
        if pressed && !self.pressed {
            self.raised = !self.raised;
        }
        self.pressed = pressed;
        self.raised &= follows_lever;
    }

    /// The set point is the lever's again.
    pub const fn lower(&mut self) {
        self.raised = false;
    }

    /// Whether the set point is the raised one.
    #[must_use]
    pub const fn is_raised(&self) -> bool {
        self.raised
    }

    /// The set point: the lever's, or the raised one.
    #[must_use]
    pub fn set_point(&self, lever: MilliDegree, parameters: &OperatorParameters) -> MilliDegree {
        if self.raised {
            parameters.quick_lift_angle
        } else {
            lever
        }
    }
}

/// Float: with the lever at its lower stop and the hitch down, both coils stay off, and ground and implement move the
/// hitch.
#[derive(Clone, Copy, Debug, Default)]
pub struct Float {
    floating: bool,
    lifted_for: Millisecond,
}

impl Float {
    /// One step; true while floating. `resting`: the hitch has arrived and nothing moves it.
    pub fn update(
        &mut self,
        lever: MilliDegree,
        angle: MilliDegree,
        resting: bool,
        parameters: &OperatorParameters,
    ) -> bool {
        if !self.floating {
            let down = lever <= parameters.float_lever && angle <= parameters.float_angle;
            *self = Self {
                floating: down && resting,
                lifted_for: Millisecond::ZERO,
            };
            return self.floating;
        }
        let is_lifted = lever >= parameters.float_exit;
        self.lifted_for = self.lifted_for.counted_while(is_lifted);
        self.floating = !is_lifted || self.lifted_for < parameters.float_exit_time;
        self.floating
    }

    /// Position control has ended.
    pub fn end(&mut self) {
        *self = Self::default();
    }

    /// True while floating.
    #[must_use]
    pub const fn is_floating(&self) -> bool {
        self.floating
    }
}

/// The highest set point: that of the calibration, or of the dial if it is lower. A dial below the lower limit gives
/// the lower limit.
#[must_use]
pub fn upper_limit(dial: Option<MilliDegree>, position: &PositionParameters) -> MilliDegree {
    dial.map_or(position.upper_limit, |dial| {
        dial.limited(position.lower_limit, position.upper_limit)
    })
}

/// Largest lowering speed by the rate dial: zero at its closed end, the speed of a new machine in the middle, the full
/// speed at its open end, linear in between. Without a dial it is the full speed.
#[must_use]
pub fn lowering_limit(
    dial: Option<PerMille>,
    operator: &OperatorParameters,
    position: &PositionParameters,
) -> MicrometrePerSecond {
    const MIDDLE: PerMille = PerMille(500);
    let Some(dial) = dial else {
        return position.lower_speed;
    };
    let middle = (MIDDLE.0, operator.dial_middle_speed.0);
    let speed = if dial < operator.dial_shut {
        0
    } else if dial < MIDDLE {
        interpolate((operator.dial_shut.0, 0), middle, dial.0)
    } else {
        let open = (operator.dial_open.0, position.lower_speed.0);
        interpolate(middle, open, dial.min(operator.dial_open).0)
    };
    MicrometrePerSecond(speed).min(position.lower_speed)
}

#[cfg(test)]
mod tests {
    use hitch_quantities::units::Count;

    use super::*;

    const OPERATOR: OperatorParameters = OperatorParameters::NOMINAL;

    #[test]
    fn the_dial_is_two_straight_pieces_between_its_ends() {
        let speed = |dial| {
            lowering_limit(
                Some(PerMille(dial)),
                &OPERATOR,
                &PositionParameters::NOMINAL,
            )
            .0
        };
        assert_eq!([speed(i32::MIN), speed(0), speed(139), speed(140)], [0; 4]);
        assert_eq!([speed(320), speed(500)], [37_500, 75_000]);
        assert_eq!(
            [speed(730), speed(960), speed(1_000), speed(i32::MAX)],
            [187_500, 300_000, 300_000, 300_000]
        );
    }

    #[test]
    fn a_cranking_engine_permits_nothing_until_it_has_settled() {
        let parameters = LockParameters::NOMINAL;
        let mut engine = EngineWatch::default();
        let mut permits =
            |rpm: Option<i32>| engine.permits(rpm.map(RevolutionPerMinute), &parameters);
        assert!(permits(None), "a machine without this signal");
        assert!((0..2_000).all(|_| !permits(Some(400))));
        assert_eq!((0..2_000).position(|_| permits(Some(401))), Some(499));
        assert!(!permits(Some(0)), "stalled");
        assert_eq!((0..2_000).position(|_| permits(Some(800))), Some(499));
        assert!(!permits(None), "silent");
        assert_eq!((0..2_000).position(|_| permits(Some(800))), Some(499));
    }

    #[test]
    fn an_engine_that_is_required_has_to_be_heard_before_the_hitch_is_used() {
        let parameters = LockParameters {
            engine_required: Count(1),
            ..LockParameters::NOMINAL
        };
        let mut engine = EngineWatch::default();
        assert!((0..2_000).all(|_| !engine.permits(None, &parameters)));
        let speed = Some(RevolutionPerMinute(800));
        assert_eq!(
            (0..2_000).position(|_| engine.permits(speed, &parameters)),
            Some(499)
        );
    }

    #[test]
    fn float_ends_only_with_a_lever_that_stays_up() {
        let mut float = Float::default();
        let (down, up) = (MilliDegree(44_600), OPERATOR.float_exit);
        let angle = MilliDegree(45_000);
        let mut update = |lever, resting| float.update(lever, angle, resting, &OPERATOR);
        assert!(!update(down, false), "still on its way");
        assert!(update(down, true));
        assert!((0..199).all(|_| update(up, true)));
        assert!(update(up - MilliDegree(1), true), "knocked");
        assert_eq!((0..1_000).position(|_| !update(up, true)), Some(199));
    }
}
