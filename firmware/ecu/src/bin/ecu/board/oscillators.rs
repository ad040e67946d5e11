//! The crystal, measured against the internal oscillator before anything depends on it.
//!
//! The watchdog's oscillator is measured twice, with the core on the internal oscillator and on the crystal. The ratio is
//! that of their rates. A board with another crystal than the image is made for is found before the PLL is started, which
//! would run the core beyond its limits.

use super::part;
use super::part::slow_clock;

/// Captured periods that are added up: 4 ms at 32 kHz.
pub const PERIODS: u32 = 16;
/// Largest deviation of the crystal from the internal oscillator, per mille.
const TOLERANCE_PER_MILLE: u32 = 30;
/// Polls for an edge, at least 10 cycles each: 12 ms and more at 16 MHz.
const MOST_POLLS: u32 = 20_000;

/// What the main clock is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The crystal.
    Crystal,
    /// The internal oscillator: accurate enough for reports, not for driving the coils.
    Internal,
}

/// Result of the measurement.
#[derive(Clone, Copy, Debug)]
pub struct Oscillators {
    /// The crystal's frequency, Hz, if the internal oscillator's is exact; 0 if it could not be measured.
    pub crystal_hz: u32,
    /// Counts of [`PERIODS`] periods of the watchdog's oscillator at the timer's full clock; 0 if there are none.
    pub slow_counts: u32,
}

impl Oscillators {
    /// Measures; afterwards the core runs from the crystal. If it never starts, the watchdog resets the part.
    pub fn measure() -> Self {
        slow_clock::start();
        let internal = counts();
        part::run_from_crystal();
        let crystal = counts();
        let (Some(internal), Some(crystal)) = (internal, crystal) else {
            return Self {
                crystal_hz: 0,
                slow_counts: 0,
            };
        };
        Self {
            crystal_hz: scaled(crystal, part::INTERNAL_HZ, internal),
            slow_counts: scaled(internal, part::TIMER_HZ, part::INTERNAL_HZ),
        }
    }

    /// The crystal if it has the expected frequency, and the watchdog's oscillator one that its data sheet allows.
    pub fn source(&self) -> Source {
        const LOW: u32 = slow_clock::COUNTS[0] * PERIODS / 1_000 * (1_000 - TOLERANCE_PER_MILLE);
        const HIGH: u32 = slow_clock::COUNTS[1] * PERIODS / 1_000 * (1_000 + TOLERANCE_PER_MILLE);
        const MOST_OFF_HZ: u32 = part::CRYSTAL_HZ / 1_000 * TOLERANCE_PER_MILLE;
        let is_good = self.crystal_hz.abs_diff(part::CRYSTAL_HZ) <= MOST_OFF_HZ
            && (LOW..=HIGH).contains(&self.slow_counts);
        match is_good {
            true => Source::Crystal,
            false => Source::Internal,
        }
    }
}

/// `value * numerator / denominator`.
fn scaled(value: u32, numerator: u32, denominator: u32) -> u32 {
    let scaled = u64::from(value)
        .saturating_mul(u64::from(numerator))
        .checked_div(u64::from(denominator));
    u32::try_from(scaled.unwrap_or(0)).unwrap_or(u32::MAX)
}

/// Counts of [`PERIODS`] captured periods at the present clock; `None` if the oscillator stands still.
fn counts() -> Option<u32> {
    // An edge of the time before the clock was switched.
    let _ = slow_clock::take();
    let mut last = next_edge()?;
    let mut sum = 0_u32;
    for _ in 0..PERIODS {
        let edge = next_edge()?;
        sum = sum.saturating_add(slow_clock::difference(edge, last));
        last = edge;
    }
    Some(sum)
}

fn next_edge() -> Option<u32> {
    (0..MOST_POLLS).find_map(|_| slow_clock::take().map(|capture| capture.count))
}
