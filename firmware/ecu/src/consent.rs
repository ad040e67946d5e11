//! The operator's consent to remote control, as control sees it: the closing of a contact, or a gesture with the lever.
//! Which of them counts is in the calibration (`remote.consent`).
//!
//! The safety envelope has its own view of it (`hitch_safety`), which shares no code with this one.

use hitch_quantities::Inputs;
use hitch_quantities::units::{Count, MilliDegree, Millisecond};

/// The consent contact counts.
const BY_CONTACT: Count = Count(1);
/// The gesture counts.
const BY_LEVER: Count = Count(2);

/// How long a contact has to be open, and then closed: longer than it bounces.
const STEADY: Millisecond = Millisecond(20);
/// How far the lever goes each way, 1.8 % of its range: five times its noise, and too little to hit anything.
const STROKE: MilliDegree = MilliDegree(2_000);
/// Strokes of the gesture: there and back, twice.
const STROKES: u8 = 4;
/// Time for each stroke after the one before.
const STROKE_TIME: Millisecond = Millisecond(700);

/// Monitors contact and lever.
#[derive(Clone, Copy, Debug, Default)]
pub struct ConsentWatch {
    contact: ContactEdge,
    lever: LeverGesture,
}

impl ConsentWatch {
    /// One step; true if the operator consents in it. `kind`: `remote.consent` of the calibration.
    pub fn update(&mut self, inputs: &Inputs, kind: Count) -> bool {
        let closes = self.contact.closes(inputs.switches.consent);
        let made = self.lever.is_made(inputs.lever);
        match kind {
            BY_CONTACT => closes,
            BY_LEVER => made,
            _ => false,
        }
    }
}

/// A contact that closes after it has been seen open.
#[derive(Clone, Copy, Debug, Default)]
struct ContactEdge {
    open_for: Millisecond,
    closed_for: Millisecond,
}

impl ContactEdge {
    /// One step; true once, when the contact has been closed for long enough.
    fn closes(&mut self, is_closed: bool) -> bool {
        if !is_closed {
            let open_for = match self.closed_for {
                Millisecond::ZERO => self.open_for.next().min(STEADY),
                _ => Millisecond(1),
            };
            *self = Self {
                open_for,
                closed_for: Millisecond::ZERO,
            };
            return false;
        }
        self.closed_for = self.closed_for.next().min(STEADY);
        let closes = self.closed_for >= STEADY && self.open_for >= STEADY;
        if closes {
            self.open_for = Millisecond::ZERO;
        }
        closes
    }
}

/// The lever is moved there and back twice, without a rest.
#[derive(Clone, Copy, Debug, Default)]
struct LeverGesture {
    /// Lowest and highest place since the last stroke ended.
    range: Option<(MilliDegree, MilliDegree)>,
    /// The last stroke: its direction, true is up, how many there were, and how long ago it ended.
    last: Option<(bool, u8, Millisecond)>,
}

impl LeverGesture {
    /// One step; true once, with the last stroke.
    fn is_made(&mut self, lever: Option<MilliDegree>) -> bool {
        let Some(lever) = lever else {
            *self = Self::default();
            return false;
        };
        let last = self
            .last
            .map(|(up, count, age)| (up, count, age.next()))
            .filter(|&(_, _, age)| age < STROKE_TIME);
        let (low, high) = self.range.unwrap_or((lever, lever));
        let rises = lever - low >= STROKE && last.is_none_or(|(up, _, _)| !up);
        let falls = high - lever >= STROKE && last.is_none_or(|(up, _, _)| up);
        if !rises && !falls {
            self.range = Some((low.min(lever), high.max(lever)));
            self.last = last;
            return false;
        }
        let count = last.map_or(1, |(_, count, _)| count.saturating_add(1));
        *self = if count >= STROKES {
            Self::default()
        } else {
            Self {
                range: Some((lever, lever)),
                last: Some((rises, count, Millisecond::ZERO)),
            }
        };
        count >= STROKES
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    /// Steps in which a contact with these states, ms each, consents.
    fn edges(states: &[(bool, usize)]) -> Vec<usize> {
        let mut contact = ContactEdge::default();
        let steps = states
            .iter()
            .flat_map(|&(closed, ms)| core::iter::repeat_n(closed, ms));
        let edges = steps.enumerate().filter(|&(_, on)| contact.closes(on));
        edges.map(|(step, _)| step).collect()
    }

    #[test]
    fn a_contact_consents_once_when_it_closes() {
        assert_eq!(edges(&[(false, 20), (true, 1_000)]), [39]);
        assert_eq!(
            edges(&[(false, 50), (true, 500), (false, 20), (true, 20)]),
            [69, 589]
        );
    }

    #[test]
    fn a_contact_that_is_closed_at_power_up_or_chatters_is_no_consent() {
        assert!(edges(&[(true, 10_000)]).is_empty());
        assert!(edges(&[(false, 19), (true, 1_000)]).is_empty());
        assert!(edges(&[(true, 19), (false, 19)].repeat(100)).is_empty());
        assert!(edges(&[(false, 100), (true, 19), (false, 19), (true, 100)]).is_empty());
    }

    /// True if a lever that visits these places within `ms` each makes the gesture.
    fn makes_gesture(places: &[i32], ms: i32) -> bool {
        let mut gesture = LeverGesture::default();
        let mut made = false;
        for ends in places.windows(2) {
            for step in 1..=ms {
                let place = ends[0] + (ends[1] - ends[0]) * step / ms;
                made |= gesture.is_made(Some(MilliDegree(place)));
            }
        }
        made
    }

    #[test]
    fn a_lever_that_is_moved_there_and_back_twice_consents() {
        let (rest, up, down) = (90_000, 93_000, 87_000);
        for way in [up, down] {
            let gesture = [rest, way, rest, way, rest];
            assert!([50, 200, 400].iter().all(|&ms| makes_gesture(&gesture, ms)));
            assert!(!makes_gesture(&gesture, 1_200), "too slow");
            assert!(!makes_gesture(&gesture[..4], 200), "once and a half");
        }
        assert!(!makes_gesture(
            &[rest, 91_500, rest, 91_500, rest, 91_500, rest],
            100
        ));
        assert!(!makes_gesture(&[40_000, 140_000], 2_000));
        assert!(!makes_gesture(&[40_000, 140_000, 40_000], 2_000));
    }

    #[test]
    fn a_lever_without_a_signal_begins_anew() {
        let mut gesture = LeverGesture::default();
        let mut made = false;
        for place in [90_000, 93_000, 90_000, 93_000] {
            made |= gesture.is_made(Some(MilliDegree(place)));
        }
        assert!(!gesture.is_made(None));
        made |= gesture.is_made(Some(MilliDegree(90_000)));
        assert!(!made);
    }

    #[test]
    fn the_calibration_says_what_counts() {
        for (kind, expected) in [(0, 0), (1, 1), (2, 0)] {
            let mut watch = ConsentWatch::default();
            let mut inputs = Inputs::default();
            let count = (0..100)
                .filter(|&step| {
                    inputs.switches.consent = step >= 50;
                    watch.update(&inputs, Count(kind))
                })
                .count();
            assert_eq!(count, expected, "{kind}");
        }
    }
}
