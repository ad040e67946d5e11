//! Speed of the machine for draft and slip control: wheel-based or ground-based (ISO 11783-7, SPN 1862 and 1859).
//!
//! Messages are accepted from any source. Of several senders of a group the first one is used until it has sent no speed for
//! the time-out, so that two sensors do not alternate. A sender without a sensor, whose messages have no speed, does not count.

use hitch_quantities::units::MillimetrePerSecond;

use super::scale::data;
use super::time::since_ms;

/// Time-out after which another sender is used, ms. The speeds are sent every 100 ms.
pub const TIMEOUT_MS: u32 = 300;

/// The sender of a speed.
#[derive(Clone, Copy, Debug)]
struct Sender {
    from: u8,
    at_ms: u32,
}

/// The receiver of one of the two groups.
#[derive(Clone, Copy, Debug, Default)]
pub struct MachineSpeed {
    sender: Option<Sender>,
    /// The last speed, until it is taken.
    received: Option<MillimetrePerSecond>,
}

impl MachineSpeed {
    /// A message was received.
    pub fn receive(&mut self, bytes: &[u8; 8], from: u8, now_ms: u32) {
        let Some(speed) = speed(bytes) else {
            return;
        };
        let other = self.fresh(now_ms).is_some_and(|sender| sender.from != from);
        if !other {
            let at_ms = now_ms;
            self.sender = Some(Sender { from, at_ms });
            self.received = Some(speed);
        }
    }

    /// The speed that was received since the last call.
    pub const fn take(&mut self) -> Option<MillimetrePerSecond> {
        self.received.take()
    }

    /// Discards a sender that is silent. Called at least once a day, because the milliseconds wrap.
    pub fn update(&mut self, now_ms: u32) {
        self.sender = self.fresh(now_ms);
    }

    fn fresh(&self, now_ms: u32) -> Option<Sender> {
        self.sender
            .filter(|sender| since_ms(sender.at_ms, now_ms) <= TIMEOUT_MS)
    }
}

/// The speed in a message of either group, forwards or in reverse.
#[must_use]
pub fn speed([low, high, ..]: &[u8; 8]) -> Option<MillimetrePerSecond> {
    data([*low, *high]).map(|raw| MillimetrePerSecond(raw.into()))
}
