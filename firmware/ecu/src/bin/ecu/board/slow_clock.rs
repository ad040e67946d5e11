//! The main clock, measured against the low-speed oscillator of the watchdog.
//!
//! A timer on the main clock captures every eighth edge of the oscillator. All other timers share the main clock and
//! cannot detect its error.

use hitch_quantities::units::PerMille;

use super::part::slow_clock as part;

/// Captured periods that are averaged: 4 ms at 32 kHz.
const PERIODS: u32 = 16;

/// The measurement.
pub struct SlowClock {
    last: Option<u32>,
    sum: u32,
    periods: u32,
    /// Counts of [`PERIODS`] periods at the start, inside what the oscillator's tolerance allows.
    reference: Option<u32>,
    ratio: Option<PerMille>,
}

impl SlowClock {
    /// Starts the timer.
    pub fn start() -> Self {
        part::start();
        Self {
            last: None,
            sum: 0,
            periods: 0,
            reference: None,
            ratio: None,
        }
    }

    /// Processes a captured edge, if there is one. Called at least four times a millisecond except during a step, which
    /// is more often than edges occur; a missed edge only invalidates its period.
    pub fn listen(&mut self) {
        let Some(capture) = part::take() else {
            return;
        };
        let Some(last) = self.last.replace(capture.count) else {
            return;
        };
        if capture.missed {
            return;
        }
        self.sum = self
            .sum
            .saturating_add(part::difference(capture.count, last));
        self.periods = self.periods.saturating_add(1);
        if self.periods == PERIODS {
            self.average();
        }
    }

    fn average(&mut self) {
        let [low, high] = part::COUNTS.map(|counts| counts * PERIODS);
        let reference = *self.reference.get_or_insert(self.sum.clamp(low, high));
        let per_mille = u64::from(self.sum) * 1_000 / u64::from(reference.max(1));
        self.ratio = Some(PerMille(i32::try_from(per_mille).unwrap_or(i32::MAX)));
        self.sum = 0;
        self.periods = 0;
    }

    /// Rate of the main clock, per mille of its rate at the start; `None` until it has been measured.
    pub const fn ratio(&self) -> Option<PerMille> {
        self.ratio
    }
}
