//! The main clock, measured against the low-speed oscillator of the watchdog.
//!
//! A timer on the main clock captures every eighth edge of the oscillator. All other timers share the main clock and
//! cannot detect its error. What the oscillator is compared with was measured by the internal one at the start, so a main
//! clock that is wrong from the start is detected as well.

use hitch_quantities::units::PerMille;

use super::oscillators::PERIODS;
use super::part::slow_clock as part;

/// The measurement.
pub struct SlowClock {
    last: Option<u32>,
    sum: u32,
    periods: u32,
    /// Counts of [`PERIODS`] periods if the main clock is right.
    reference: u32,
    ratio: Option<PerMille>,
}

impl SlowClock {
    /// The timer runs; it counts `reference` in [`PERIODS`] periods if the main clock is right.
    pub const fn new(reference: u32) -> Self {
        Self {
            last: None,
            sum: 0,
            periods: 0,
            reference,
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
        let per_mille = u64::from(self.sum) * 1_000 / u64::from(self.reference.max(1));
        self.ratio = Some(PerMille(i32::try_from(per_mille).unwrap_or(i32::MAX)));
        self.sum = 0;
        self.periods = 0;
    }

    /// Rate of the main clock, per mille of its nominal rate; `None` until it has been measured.
    pub const fn ratio(&self) -> Option<PerMille> {
        self.ratio
    }
}
