//! The operator's consent to remote control, as the envelope sees it: from the contact and the lever, not from control.
//!
//! ```text
//!            consent               a set point within 2 s
//!  +------+ --------> +---------+ ------------------------> +---------+
//!  | None |           | Granted |                           | Covered |
//!  +------+ <-------- +---------+                           +---------+
//!      ^     2 s without one                                     | no set point, lever moved, button, a lock, a trip
//!      +---------------------------------------------------------+
//! ```
//!
//! An implement's set point is covered from its beginning to its end, or not at all.

use hitch_quantities::Inputs;
use hitch_quantities::calibration::design_parameters::RemoteParameters;
use hitch_quantities::units::{MilliDegree, Millisecond};

use crate::locks::Lock;

/// Value of `remote.consent`: the contact.
const CONTACT: i32 = 1;
/// The same: the lever.
const LEVER: i32 = 2;
/// How long a contact is open, then closed: beyond its bounce.
const BOUNCE: Millisecond = Millisecond(20);
/// How long a consent is good for an implement that begins: 1.5 s by the rules of the bus, and margin.
const GOOD_FOR: Millisecond = Millisecond(2_000);
/// Movement of the lever that takes the hitch back: twice that of control, which sees it first.
const TAKEN_BACK: MilliDegree = MilliDegree(1_500);
/// A turn of the lever, and how many of them consent: there and back twice.
const TURN: MilliDegree = MilliDegree(2_000);
const TURNS: i32 = 4;
/// Longest time between two turns.
const TURN_TIME: Millisecond = Millisecond(700);

/// The view.
#[derive(Clone, Copy, Debug, Default)]
pub struct Consent {
    contact: Contact,
    swing: Swing,
    state: State,
}

#[derive(Clone, Copy, Debug, Default)]
enum State {
    #[default]
    None,
    /// The operator consented so long ago.
    Granted(Millisecond),
    /// A set point is covered; where the lever was when it began.
    Covered(MilliDegree),
}

impl Consent {
    /// One step; true if the set point of an implement is there and is not covered. While a lock is closed, `lock` cuts
    /// the coils.
    pub fn is_missing(
        &mut self,
        inputs: &Inputs,
        lock: Lock,
        parameters: &RemoteParameters,
    ) -> bool {
        let closes = self.contact.closes(inputs.switches.consent);
        let turned = self.swing.is_complete(inputs.lever);
        let consents = match parameters.consent.0 {
            CONTACT => closes,
            LEVER => turned,
            _ => false,
        };
        let lever = inputs.lever;
        let is_asked = inputs.set_point.is_some();
        let is_operated = lock != Lock::Open || inputs.jog.is_some();
        self.state = match self.state {
            _ if is_operated => State::None,
            State::Covered(from) if is_asked => match lever {
                Some(lever) if (lever - from).magnitude() > TAKEN_BACK => State::None,
                _ => State::Covered(from),
            },
            State::Granted(_) if is_asked => lever.map_or(State::None, State::Covered),
            _ if is_asked => State::None,
            _ if consents => State::Granted(Millisecond::ZERO),
            State::Granted(age) if age < GOOD_FOR => State::Granted(age.next()),
            _ => State::None,
        };
        is_asked && lock == Lock::Open && !matches!(self.state, State::Covered(_))
    }
}

/// A contact: how long it has been as it is, and whether it was open for long enough before.
#[derive(Clone, Copy, Debug, Default)]
struct Contact {
    is_closed: bool,
    steady_for: Millisecond,
    was_open: bool,
}

impl Contact {
    /// One step; true when a contact that was open is closed for good.
    fn closes(&mut self, is_closed: bool) -> bool {
        if is_closed != self.is_closed {
            self.was_open = is_closed && self.steady_for >= BOUNCE;
            self.is_closed = is_closed;
            self.steady_for = Millisecond::ZERO;
        }
        self.steady_for = self.steady_for.next().min(BOUNCE);
        let closes = self.was_open && self.steady_for >= BOUNCE;
        if closes {
            self.was_open = false;
        }
        closes
    }
}

/// The lever that is moved there and back.
#[derive(Clone, Copy, Debug, Default)]
struct Swing {
    /// Lowest and highest place since the last turn.
    ends: Option<[MilliDegree; 2]>,
    /// The way it went to the last turn: 1 is up, -1 down.
    way: i32,
    turns: i32,
    since_turn: Millisecond,
}

impl Swing {
    /// One step; true with the last turn. A swing that takes too long begins anew.
    fn is_complete(&mut self, lever: Option<MilliDegree>) -> bool {
        let Some(lever) = lever else {
            *self = Self::default();
            return false;
        };
        self.since_turn = self.since_turn.next().min(TURN_TIME);
        if self.since_turn >= TURN_TIME {
            (self.way, self.turns) = (0, 0);
        }
        let [lowest, highest] = self.ends.unwrap_or([lever; 2]);
        self.ends = Some([lowest.min(lever), highest.max(lever)]);
        let turns_to = if self.way <= 0 && lever - lowest >= TURN {
            1
        } else if self.way >= 0 && highest - lever >= TURN {
            -1
        } else {
            return false;
        };
        let turns = self.turns.saturating_add(1);
        if turns >= TURNS {
            *self = Self::default();
            return true;
        }
        *self = Self {
            ends: Some([lever; 2]),
            way: turns_to,
            turns,
            since_turn: Millisecond::ZERO,
        };
        false
    }
}
