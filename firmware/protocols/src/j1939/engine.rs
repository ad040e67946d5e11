//! Engine speed, as broadcast by the engine controller (EEC1, SAE J1939-71, SPN 190).
//!
//! The message is accepted from the two addresses of the calibration only: engines have 0 or 1, and on some tractors
//! another unit forwards it. Of two senders the first one is used until it has been silent for the time-out, so that two
//! engines do not alternate.

use hitch_quantities::units::RevolutionPerMinute;

use super::scale::data;
use super::time::since_ms;

/// Time-out after which the speed is unknown, ms. EEC1 is sent every 10 to 100 ms.
pub const TIMEOUT_MS: u32 = 300;
/// Raw counts of 1/min.
const COUNTS_PER_RPM: u16 = 8;

/// The last message.
#[derive(Clone, Copy, Debug)]
struct LastSpeed {
    from: u8,
    speed: Option<RevolutionPerMinute>,
    at_ms: u32,
}

/// Addresses of the first and the second engine.
const ENGINES: [u8; 2] = [0, 1];

/// The receiver.
#[derive(Clone, Copy, Debug)]
pub struct EngineSpeed {
    sources: [u8; 2],
    last: Option<LastSpeed>,
}

impl Default for EngineSpeed {
    fn default() -> Self {
        Self {
            sources: ENGINES,
            last: None,
        }
    }
}

impl EngineSpeed {
    /// Accepts the speed from these addresses only.
    pub fn accept_from(&mut self, sources: [u8; 2]) {
        self.sources = sources;
    }

    /// A message was received.
    pub fn receive(&mut self, bytes: &[u8; 8], from: u8, now_ms: u32) {
        let other = self.fresh(now_ms).is_some_and(|last| last.from != from);
        if self.sources.contains(&from) && !other {
            self.last = Some(LastSpeed {
                from,
                speed: speed(bytes),
                at_ms: now_ms,
            });
        }
    }

    /// The speed; `None` before the first message, while the message reports it as unknown, and after the time-out.
    #[must_use]
    pub fn speed(&self, now_ms: u32) -> Option<RevolutionPerMinute> {
        self.fresh(now_ms)?.speed
    }

    /// Discards a message that is too old. Called at least once a day, because the milliseconds wrap.
    pub fn update(&mut self, now_ms: u32) {
        self.last = self.fresh(now_ms);
    }

    fn fresh(&self, now_ms: u32) -> Option<LastSpeed> {
        self.last
            .filter(|last| since_ms(last.at_ms, now_ms) <= TIMEOUT_MS)
    }
}

/// The speed in a message, rounded down.
fn speed([_, _, _, low, high, ..]: &[u8; 8]) -> Option<RevolutionPerMinute> {
    data([*low, *high]).map(|raw| RevolutionPerMinute(i32::from(raw / COUNTS_PER_RPM)))
}
