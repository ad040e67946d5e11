//! Quick engagement: a switch that lowers the implement into the soil while it is held.
//!
//! A press counts if it begins while the hitch follows the lever: a switch that is held at power-up, in a lock or during a
//! fault has to be released first. It ends with the release, and before that where the operator raises the lever, presses
//! quick lift, or an implement has the command.

use hitch_quantities::calibration::design_parameters::LockParameters;
use hitch_quantities::units::MilliDegree;

/// What the switch asks for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Engagement {
    /// Nothing.
    #[default]
    Off,
    /// A press begins in this step.
    Begins,
    /// It goes on.
    Held,
}

/// The switch from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct EngageSwitch {
    pressed: bool,
    /// Lever when the press began, while it counts.
    lever_then: Option<MilliDegree>,
}

impl EngageSwitch {
    /// One step in which the hitch follows the lever.
    pub fn step(
        &mut self,
        pressed: bool,
        lever: MilliDegree,
        parameters: &LockParameters,
    ) -> Engagement {
        let begins = pressed && !self.pressed;
        self.pressed = pressed;
        if begins {
            self.lever_then = Some(lever);
            return Engagement::Begins;
        }
        let raised = |then: &MilliDegree| lever - *then >= parameters.lever_movement;
        self.lever_then = self.lever_then.filter(|then| pressed && !raised(then));
        self.lever_then
            .map_or(Engagement::Off, |_| Engagement::Held)
    }

    /// The hitch does not follow the lever: the press has ended, and the next one has to begin afterwards.
    pub const fn end(&mut self) {
        self.lever_then = None;
        self.pressed = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOCK: LockParameters = LockParameters::NOMINAL;
    const LEVER: MilliDegree = MilliDegree(120_000);

    #[test]
    fn a_press_counts_from_its_beginning_to_its_release() {
        let mut switch = EngageSwitch::default();
        let pressed = [false, true, true, false, false, true];
        let found = pressed.map(|pressed| switch.step(pressed, LEVER, &LOCK));
        use Engagement::{Begins, Held, Off};
        assert_eq!(found, [Off, Begins, Held, Off, Off, Begins]);
    }

    #[test]
    fn a_switch_that_was_held_before_has_to_be_released() {
        let mut switch = EngageSwitch::default();
        switch.end();
        assert_eq!(switch.step(true, LEVER, &LOCK), Engagement::Off);
        assert_eq!(switch.step(false, LEVER, &LOCK), Engagement::Off);
        assert_eq!(switch.step(true, LEVER, &LOCK), Engagement::Begins);
        switch.end();
        assert_eq!(switch.step(true, LEVER, &LOCK), Engagement::Off);
    }

    #[test]
    fn a_raised_lever_ends_it_until_the_next_press_and_a_lowered_one_does_not() {
        let mut switch = EngageSwitch::default();
        switch.step(true, LEVER, &LOCK);
        let down = LEVER - LOCK.lever_movement - LOCK.lever_movement;
        assert_eq!(switch.step(true, down, &LOCK), Engagement::Held);
        let up = LEVER + LOCK.lever_movement;
        assert_eq!(switch.step(true, up, &LOCK), Engagement::Off);
        assert_eq!(switch.step(true, LEVER, &LOCK), Engagement::Off);
    }
}
