//! What a board has found at its start.

use hitch_protocols::j1939::{Trouble, Troubles};

/// Troubles that last until the next start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StartCheck {
    /// What is reported.
    pub troubles: Troubles,
    /// The hitch is locked.
    pub locks: bool,
}

impl StartCheck {
    /// Reports a trouble.
    pub const fn note(&mut self, trouble: Trouble) {
        self.troubles.insert(trouble);
    }

    /// Reports a trouble and locks the hitch.
    pub const fn lock(&mut self, trouble: Trouble) {
        self.note(trouble);
        self.locks = true;
    }
}
