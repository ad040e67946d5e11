//! Trouble codes of the CAN controller: bus-off and lost frames.

use hitch_protocols::j1939::{Trouble, Troubles};

/// Time that a code stays active after its cause, ms: five of the periods in which DM1 is sent. A code that ended with its
/// cause would not be sent, since nothing is sent during bus-off.
const HELD_MS: u16 = 5_000;

/// Watches the CAN controller.
#[derive(Clone, Copy, Debug, Default)]
pub struct BusWatch {
    /// Dropped frames at the last look; `None`: the next count is adopted.
    dropped: Option<u16>,
    off_for_ms: u16,
    lost_for_ms: u16,
}

impl BusWatch {
    /// A look in each millisecond: whether the controller is in bus-off, and the number of dropped frames, which wraps.
    /// The first count is adopted: frames were lost before the application received any.
    pub fn update(&mut self, is_off: bool, dropped: u16) {
        let has_lost = self
            .dropped
            .replace(dropped)
            .is_some_and(|before| before != dropped);
        self.off_for_ms = held(self.off_for_ms, is_off);
        self.lost_for_ms = held(self.lost_for_ms, has_lost);
    }

    /// Adopts the next count: the processor does not receive frames during a flash operation.
    pub const fn excuse(&mut self) {
        self.dropped = None;
    }

    /// The active troubles.
    #[must_use]
    pub fn troubles(&self) -> Troubles {
        let mut found = Troubles::NONE;
        if self.off_for_ms > 0 {
            found.insert(Trouble::BusOff);
        }
        if self.lost_for_ms > 0 {
            found.insert(Trouble::FramesLost);
        }
        found
    }
}

const fn held(left_ms: u16, is_there: bool) -> u16 {
    if is_there {
        HELD_MS
    } else {
        left_ms.saturating_sub(1)
    }
}
