//! The external button: which of its presses count, and how far each of them moves the hitch.
//!
//! A button has one contact, or a second one that opens when the first one closes (`operator.second_contact`). Contacts
//! that contradict each other are neither a press nor a release.
//!
//! The safety envelope has its own view of it (`hitch_safety`), which shares no code with this one.

use hitch_quantities::units::{MilliDegree, MilliDegreePerSecond, Millisecond};
use hitch_quantities::{Calibration, Inputs};

/// How long a button has to be released: longer than its contacts bounce.
const STEADY: Millisecond = Millisecond(20);
/// How long its contacts may contradict each other on the way from one end to the other.
const ON_THE_WAY: Millisecond = Millisecond(100);
/// Time in which a hitch stops from the speed of the button: its ramp, and the closing of the slowest valve.
const STOP_TIME: Millisecond = Millisecond(150);

/// What the contacts of both buttons say.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reading {
    /// Both are released.
    Released,
    /// One is pressed, with its request.
    Pressed(MilliDegreePerSecond),
    /// Both are pressed, or contacts contradict each other.
    Unclear,
}

impl Reading {
    fn of(inputs: &Inputs, has_second_contact: bool) -> Self {
        let rate = inputs.jog.map_or(0, |jog| jog.0);
        let released = [inputs.switches.up_released, inputs.switches.down_released];
        let both = inputs.jog.is_some() && rate == 0;
        if both || has_second_contact && released != [rate <= 0, rate >= 0] {
            return Self::Unclear;
        }
        inputs.jog.map_or(Self::Released, Self::Pressed)
    }
}

/// Passes a press only after the button has been seen released, and ends it after its longest travel: a button that is
/// pressed at power-up or during a fault is stuck or pressed by accident, and one that stays pressed may be a shorted
/// wire.
#[derive(Clone, Copy, Debug, Default)]
pub struct ButtonGuard {
    released_for: Millisecond,
    unclear_for: Millisecond,
    /// The button was seen released, and nothing has happened since that requires it to be released again.
    trusted: bool,
    /// Where the hitch was when the press began.
    began_at: Option<MilliDegree>,
}

impl ButtonGuard {
    /// One step; the request that counts. `angle`: of the rocker. `teaches`: the press teaches, and moves to both ends.
    pub fn pass(
        &mut self,
        inputs: &Inputs,
        angle: MilliDegree,
        teaches: bool,
        calibration: &Calibration,
    ) -> Option<MilliDegreePerSecond> {
        let reading = Reading::of(inputs, calibration.operator.second_contact.0 != 0);
        self.count(reading);
        let Reading::Pressed(request) = reading else {
            return None;
        };
        let rate = request
            .magnitude()
            .min(calibration.rate.rate_limit.magnitude());
        let began_at = *self.began_at.get_or_insert(angle);
        let gone = (angle - began_at).magnitude() + stopping(rate);
        if gone >= calibration.rate.longest_travel && !teaches {
            self.trusted = false;
        }
        self.trusted.then_some(request)
    }

    /// Requires the button to be seen released again.
    pub fn distrust(&mut self) {
        *self = Self::default();
    }

    fn count(&mut self, reading: Reading) {
        let is_released = reading == Reading::Released;
        let is_unclear = reading == Reading::Unclear;
        self.released_for = self.released_for.counted_while(is_released).min(STEADY);
        self.unclear_for = self.unclear_for.counted_while(is_unclear).min(ON_THE_WAY);
        if self.released_for >= STEADY {
            self.trusted = true;
            self.began_at = None;
        }
        if self.unclear_for >= ON_THE_WAY {
            self.trusted = false;
        }
    }
}

/// Travel in which the hitch stops from a speed.
fn stopping(rate: MilliDegreePerSecond) -> MilliDegree {
    MilliDegree(rate.0.saturating_mul(STOP_TIME.0) / 1_000)
}

#[cfg(test)]
mod tests {
    use hitch_quantities::Switches;
    use hitch_quantities::units::Count;

    use super::*;

    const UP: Option<MilliDegreePerSecond> = Some(MilliDegreePerSecond(15_000));
    const DOWN: Option<MilliDegreePerSecond> = Some(MilliDegreePerSecond(-15_000));
    const BOTH: Option<MilliDegreePerSecond> = Some(MilliDegreePerSecond(0));

    struct Press {
        guard: ButtonGuard,
        calibration: Calibration,
        angle: i32,
        teaches: bool,
    }

    impl Press {
        fn with_contacts(second: bool) -> Self {
            let mut calibration = Calibration::nominal();
            calibration.operator.second_contact = Count(i32::from(second));
            Self {
                guard: ButtonGuard::default(),
                calibration,
                angle: 90_000,
                teaches: false,
            }
        }

        /// Milliseconds with these contacts, and a hitch that moves by the request; the last request.
        fn run(
            &mut self,
            ms: usize,
            jog: Option<MilliDegreePerSecond>,
            released: [bool; 2],
        ) -> Option<MilliDegreePerSecond> {
            let inputs = Inputs {
                jog,
                switches: Switches {
                    up_released: released[0],
                    down_released: released[1],
                    ..Switches::default()
                },
                ..Inputs::default()
            };
            (0..ms)
                .map(|_| {
                    let angle = MilliDegree(self.angle);
                    let calibration = &self.calibration;
                    let request = self.guard.pass(&inputs, angle, self.teaches, calibration);
                    self.angle += request.map_or(0, |request| request.0 / 1_000);
                    request
                })
                .last()
                .flatten()
        }

        fn released(&mut self, ms: usize) {
            assert_eq!(self.run(ms, None, [true, true]), None);
        }
    }

    #[test]
    fn a_button_that_was_never_released_does_nothing() {
        let mut press = Press::with_contacts(false);
        assert_eq!(press.run(1_000, UP, [false, false]), None);
        press.released(19);
        assert_eq!(press.run(100, UP, [false, false]), None, "a bounce");
        press.released(20);
        assert_eq!(press.run(1, UP, [false, false]), UP);
        press.guard.distrust();
        assert_eq!(press.run(100, UP, [false, false]), None);
    }

    #[test]
    fn a_press_ends_short_of_its_longest_travel_and_the_next_one_needs_a_release() {
        for (jog, sign) in [(UP, 1), (DOWN, -1)] {
            let mut press = Press::with_contacts(false);
            press.released(20);
            assert_eq!(press.run(8_000, jog, [false, false]), None);
            let gone = (press.angle - 90_000) * sign;
            assert!((27_600..=27_900).contains(&gone), "{gone}");
            press.released(19);
            assert_eq!(press.run(100, jog, [false, false]), None);
            press.released(20);
            assert_eq!(press.run(1, jog, [false, false]), jog);
        }
    }

    #[test]
    fn the_other_button_ends_no_press_of_a_shorted_one() {
        let mut press = Press::with_contacts(false);
        press.released(20);
        press.run(8_000, UP, [false, false]);
        assert_eq!(press.run(500, BOTH, [false, false]), None);
        assert_eq!(press.run(500, UP, [false, false]), None);
    }

    #[test]
    fn teaching_moves_to_both_ends() {
        let mut press = Press::with_contacts(false);
        press.teaches = true;
        press.released(20);
        assert_eq!(press.run(8_000, UP, [false, false]), UP);
        press.teaches = false;
        assert_eq!(
            press.run(1, UP, [false, false]),
            None,
            "since its beginning"
        );
    }

    #[test]
    fn contacts_that_contradict_each_other_move_nothing() {
        let mut press = Press::with_contacts(true);
        press.released(20);
        assert_eq!(press.run(1_000, UP, [true, true]), None, "a shorted wire");
        assert_eq!(press.run(1_000, UP, [false, true]), None, "since then");
        press.released(20);
        assert_eq!(press.run(1_000, UP, [false, false]), None);
        press.released(20);
        assert_eq!(press.run(1_000, None, [false, true]), None);
        press.released(20);
        assert_eq!(press.run(99, None, [false, true]), None, "on its way");
        assert_eq!(press.run(10, UP, [false, true]), UP);
        press.released(20);
        assert_eq!(press.run(10, DOWN, [true, false]), DOWN);
        assert_eq!(press.run(10, BOTH, [false, false]), None);
    }
}
