//! Checks the calibration that is in use against its checksum, over and over: memory may lose a bit while the hitch works.
//!
//! A word a step, so all of it in as many milliseconds as it has words. What is derived from it, such as the inverse
//! curves of the valves, is not checked.

use hitch_quantities::Calibration;
use hitch_quantities::calibration::calibration_words::CALIBRATION_WORDS;
use hitch_quantities::crc32::Crc32;

/// The word that holds the checksum of those before it.
const CHECKSUM_WORD: usize = CALIBRATION_WORDS - 1;

/// A check under way.
#[derive(Clone, Debug, Default)]
pub struct MemoryCheck {
    next: usize,
    digest: Crc32,
    damaged: bool,
}

impl MemoryCheck {
    /// One step: the next word. True from the first mismatch on.
    pub fn step(&mut self, calibration: &Calibration) -> bool {
        if self.next < CHECKSUM_WORD {
            let word = calibration.word(self.next).unwrap_or(0);
            self.digest.update(&word.to_le_bytes());
            self.next = self.next.saturating_add(1);
        } else {
            self.damaged |= self.digest.value() != calibration.checksum;
            self.next = 0;
            self.digest = Crc32::default();
        }
        self.damaged
    }

    /// Another calibration is in use: what was read of the last one doesn't count.
    pub fn begin_anew(&mut self) {
        self.next = 0;
        self.digest = Crc32::default();
    }
}
