//! A free-running clock of microseconds (TIM2), independent of the timer of the milliseconds: the controller detects a
//! wrong rate of that timer.

use stm32_metapac::TIM2;

/// The clock.
pub struct Clock(());

impl Clock {
    /// Starts it at a timer clock of `timer_hz`.
    pub fn start(timer_hz: u32) -> Self {
        let prescaler = timer_hz / 1_000_000 - 1;
        TIM2.psc()
            .write_value(u16::try_from(prescaler).unwrap_or(u16::MAX));
        TIM2.arr().write_value(u32::MAX);
        TIM2.egr().write(|w| w.set_ug(true));
        TIM2.cr1().write(|w| w.set_cen(true));
        Self(())
    }

    /// Microseconds since the start; wraps after 71 minutes.
    pub fn now_us(&self) -> u32 {
        TIM2.cnt().read()
    }
}
