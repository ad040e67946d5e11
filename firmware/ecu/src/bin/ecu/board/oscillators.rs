//! The crystal, measured against the internal oscillator before anything depends on it.
//!
//! The watchdog's oscillator is measured twice, with the core on the internal oscillator and on the crystal. The ratio is
//! that of their rates. A board with another crystal than the image is made for is found before the PLL is started, which
//! would run the core beyond its limits.
//!
//! The internal oscillator is the measure, and its data sheet says how good it is. Limits narrower than that would refuse a sound
//! board in the cold. Within the limits, an error of the crystal looks the same as an error of the internal oscillator.

use super::clock_source::Source;
use super::core_clock;
use super::part;
use super::part::slow_clock;

/// Captured periods that are added up: 4 ms at 32 kHz.
pub const PERIODS: u32 = 16;
/// Readings of a sound crystal, lowest and highest, Hz: the internal oscillator as fast or as slow as its data sheet allows, and
/// 3 per mille for the crystal, and for what the watchdog's oscillator drifts between the two measurements. The STM32G474 gets
/// 97.6 to 103.2 %, the STM32F405 95.4 to 109.0 %.
const READINGS_HZ: [u32; 2] = [
    part::CRYSTAL_HZ / part::INTERNAL_RANGE_PER_MILLE[1] * (1_000 - MEASURING_PER_MILLE),
    part::CRYSTAL_HZ / part::INTERNAL_RANGE_PER_MILLE[0] * (1_000 + MEASURING_PER_MILLE),
];
const MEASURING_PER_MILLE: u32 = 3;
/// Polls for an edge, at least 10 cycles each: 12 ms and more at 16 MHz.
const MOST_POLLS: u32 = 20_000;

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
        core_clock::run_from_crystal(part::WAIT_STATES);
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
        const LOW: u32 =
            slow_clock::COUNTS[0] * PERIODS / 1_000 * part::INTERNAL_RANGE_PER_MILLE[0];
        const HIGH: u32 =
            slow_clock::COUNTS[1] * PERIODS / 1_000 * part::INTERNAL_RANGE_PER_MILLE[1];
        let is_good = (READINGS_HZ[0]..=READINGS_HZ[1]).contains(&self.crystal_hz)
            && (LOW..=HIGH).contains(&self.slow_counts);
        if is_good {
            Source::Crystal
        } else {
            Source::Internal
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
