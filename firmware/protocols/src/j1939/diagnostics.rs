//! Active and previously active trouble codes, and the messages DM1 and DM2 (SAE J1939-73, ISO 11783-12).
//!
//! ```text
//! byte 1     2      3        4         5                        6                 7..
//! lamps   flashing  SPN low  SPN high  SPN bits 18..16 and FMI  0 and occurrence  more codes, or FF FF
//! ```
//!
//! The two standards differ in when DM1 is sent and in its first two bytes; see [`Variant`].

use heapless::Vec;

use super::time::is_due;
use super::trouble::{Trouble, Troubles};

/// Minimum interval of DM1, ms, and its interval while a code is active.
pub const DM1_PERIOD_MS: u32 = 1_000;
/// Number of trouble codes.
pub const KINDS: usize = Trouble::ALL.len();
/// Longest message: the lamps, and a code for each trouble.
pub const LONGEST_MESSAGE: usize = 2 + 4 * KINDS;
/// Maximum count of occurrences; 127 means that the count is not available.
const MOST_OCCURRENCES: u8 = 126;

/// Occurrences of each trouble, in the order of [`Trouble::ALL`]; 0: never, or cleared.
pub type Occurrences = [u8; KINDS];

/// A message of trouble codes.
pub type Message = Vec<u8, LONGEST_MESSAGE>;

/// Standard of the bus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Variant {
    /// ISO 11783: no lamps (FF FF), and DM1 stops when no code is active.
    #[default]
    Iso11783,
    /// SAE J1939: lamp states, and DM1 continues without active codes.
    J1939,
}

/// Active and previously active codes with their counts.
#[derive(Clone, Debug)]
pub struct Diagnostics {
    variant: Variant,
    active: Troubles,
    previous: Troubles,
    occurrences: Occurrences,
    sent_ms: Option<u32>,
}

impl Diagnostics {
    /// Initially no code is active; codes from before the start are previously active.
    #[must_use]
    pub fn new(variant: Variant, before: &Occurrences) -> Self {
        let mut previous = Troubles::NONE;
        for (&trouble, &count) in Trouble::ALL.iter().zip(before) {
            if count > 0 {
                previous.insert(trouble);
            }
        }
        Self {
            variant,
            active: Troubles::NONE,
            previous,
            occurrences: before.map(|count| count.min(MOST_OCCURRENCES)),
            sent_ms: None,
        }
    }

    /// Occurrences of each trouble.
    #[must_use]
    pub const fn occurrences(&self) -> &Occurrences {
        &self.occurrences
    }

    /// Updates the active codes.
    pub fn update(&mut self, troubles: Troubles) {
        if troubles == self.active {
            return;
        }
        for begun in troubles.without(self.active).iter() {
            if let Some(count) = self.occurrences.get_mut(begun as usize) {
                *count = count.saturating_add(1).min(MOST_OCCURRENCES);
            }
        }
        let ended = self.active.without(troubles);
        self.previous = self.previous.union(ended).without(troubles);
        self.active = troubles;
    }

    /// Clears previously active codes and counts (DM3). Active codes stay.
    pub fn clear_previous(&mut self) {
        for forgotten in self.previous.iter() {
            if let Some(count) = self.occurrences.get_mut(forgotten as usize) {
                *count = 0;
            }
        }
        self.previous = Troubles::NONE;
    }

    /// Whether DM1 is due. A change is reported at once, after the minimum interval.
    #[must_use]
    pub fn due(&self, now_ms: u32) -> bool {
        is_due(self.sent_ms, DM1_PERIOD_MS, now_ms)
            && match self.variant {
                Variant::J1939 => true,
                Variant::Iso11783 => !self.active.is_empty(),
            }
    }

    /// DM1 was sent.
    pub fn sent(&mut self, now_ms: u32) {
        self.sent_ms = Some(now_ms);
    }

    /// DM1: active codes.
    #[must_use]
    pub fn dm1(&self) -> Message {
        self.message(self.active)
    }

    /// DM2: previously active codes.
    #[must_use]
    pub fn dm2(&self) -> Message {
        self.message(self.previous)
    }

    fn message(&self, troubles: Troubles) -> Message {
        let lamps = match self.variant {
            Variant::Iso11783 => 0xFF,
            Variant::J1939 => lamps(self.active),
        };
        let head = [lamps, 0xFF];
        let nothing = [[0; 4]].into_iter().filter(|_| troubles.is_empty());
        let codes = troubles.iter().map(|trouble| self.code(trouble));
        head.into_iter()
            .chain(nothing.flatten())
            .chain(codes.flatten())
            .take(LONGEST_MESSAGE)
            .collect()
    }

    /// A code of four bytes, in the order of version 4 of the conversion method.
    fn code(&self, trouble: Trouble) -> [u8; 4] {
        let code = trouble.code();
        let [low, high, highest, _] = code.spn.to_le_bytes();
        let count = self.occurrences.get(trouble as usize);
        [
            low,
            high,
            (highest << 5) | (code.fmi & 0x1F),
            count.copied().unwrap_or(MOST_OCCURRENCES),
        ]
    }
}

/// The amber lamp for any code, the red one for codes that prohibit further use of the hitch. The other two lamps are
/// off.
fn lamps(active: Troubles) -> u8 {
    const AMBER: u8 = 0b01 << 2;
    const RED: u8 = 0b01 << 4;
    if active.iter().any(is_grave) {
        RED
    } else if active.is_empty() {
        0
    } else {
        AMBER
    }
}

const fn is_grave(trouble: Trouble) -> bool {
    matches!(
        trouble,
        Trouble::LiftCoilShort
            | Trouble::LoweringCoilShort
            | Trouble::Against
            | Trouble::Sinking
            | Trouble::Controller
            | Trouble::SafetyValuesLost
    )
}
