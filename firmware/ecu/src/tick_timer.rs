//! Tick timer: counts milliseconds and measures the interval of ticks with a second clock.

use hitch_quantities::units::Microsecond;

/// Tick counter and interval measurement.
#[derive(Clone, Copy, Debug, Default)]
pub struct TickTimer {
    now_ms: u32,
    last_us: Option<u32>,
    longest_us: u16,
}

impl TickTimer {
    /// A tick begins; the time since the last one began.
    pub fn begin(&mut self, clock_us: u32) -> Option<Microsecond> {
        self.now_ms = self.now_ms.wrapping_add(1);
        let last_us = self.last_us.replace(clock_us)?;
        let step_us = clock_us.wrapping_sub(last_us);
        self.longest_us = self
            .longest_us
            .max(u16::try_from(step_us).unwrap_or(u16::MAX));
        Some(Microsecond(i32::try_from(step_us).unwrap_or(i32::MAX)))
    }

    /// Skips the next interval: this tick is delayed intentionally, with both coils off.
    pub const fn skip_interval(&mut self) {
        self.last_us = None;
    }

    /// Milliseconds since the start; wraps.
    #[must_use]
    pub const fn now_ms(&self) -> u32 {
        self.now_ms
    }

    /// Longest time between two ticks, us.
    #[must_use]
    pub const fn longest_us(&self) -> u16 {
        self.longest_us
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_that_wraps_is_no_overrun() {
        let mut timer = TickTimer::default();
        assert_eq!(timer.begin(u32::MAX - 300), None);
        assert_eq!(timer.begin(699), Some(Microsecond(1_000)));
        assert_eq!((timer.now_ms(), timer.longest_us()), (2, 1_000));
    }

    #[test]
    fn an_intentional_delay_is_skipped_once() {
        let mut timer = TickTimer::default();
        timer.begin(0);
        timer.skip_interval();
        assert_eq!(timer.begin(1_000_000), None);
        assert_eq!(timer.begin(1_900_000), Some(Microsecond(900_000)));
    }
}
