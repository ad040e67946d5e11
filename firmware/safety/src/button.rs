//! The external button, as the envelope sees it: from the contacts, not from control.
//!
//! ```text
//!                 released for 20 ms            pressed               beyond the longest travel, or
//!  +------------+ -----------------> +--------+ -------> +---------+  contradicting for 200 ms
//!  | Distrusted |                    | Ready  |          | Pressed | ---------------------------> Distrusted
//!  +------------+                    +--------+ <------- +---------+
//!                                         released for 20 ms
//! ```
//!
//! Where a button has a second contact, it is pressed only while both say so, and released only while both say so.

use hitch_quantities::Inputs;
use hitch_quantities::units::Millisecond;

/// Release that counts: beyond the bounce of a contact.
const BOUNCE: Millisecond = Millisecond(20);
/// Longest contradiction of two contacts: that of a slow finger.
const CONTRADICTION: Millisecond = Millisecond(200);

/// What a step says of the button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Press {
    /// No press counts.
    None,
    /// A press begins.
    Begins,
    /// It goes on.
    GoesOn,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    #[default]
    Distrusted,
    Ready,
    Pressed,
}

/// The view.
#[derive(Clone, Copy, Debug, Default)]
pub struct Button {
    state: State,
    idle_for: Millisecond,
    contradicts_for: Millisecond,
}

impl Button {
    /// One step.
    pub fn judge(&mut self, inputs: &Inputs, has_second_contact: bool) -> Press {
        let (idle, up, down) = match inputs.jog {
            None => (true, false, false),
            Some(jog) => (false, jog.0 > 0, jog.0 < 0),
        };
        // Both pressed is a request of no rate.
        let both = !idle && !up && !down;
        let switches = &inputs.switches;
        let agree = !has_second_contact
            || (switches.up_released != (up || both) && switches.down_released != (down || both));
        self.idle_for = self.idle_for.counted_while(idle && agree).min(BOUNCE);
        let contradicts_for = self.contradicts_for.counted_while(!agree);
        self.contradicts_for = contradicts_for.min(CONTRADICTION);
        if self.contradicts_for >= CONTRADICTION {
            self.state = State::Distrusted;
        } else if self.idle_for >= BOUNCE {
            self.state = State::Ready;
        }
        let pressed = agree && (up || down);
        match self.state {
            State::Ready if pressed => {
                self.state = State::Pressed;
                Press::Begins
            }
            State::Pressed if pressed => Press::GoesOn,
            _ => Press::None,
        }
    }

    /// It has to be seen released.
    pub fn distrust(&mut self) {
        *self = Self::default();
    }
}
