//! The independent watchdog, with its own oscillator. It cannot be stopped once started.

use hitch_ecu::Kick;
use stm32_metapac::IWDG;
use stm32_metapac::iwdg::vals::{Key, Pr};

/// 10 ms at 32 kHz / 4; the oscillator runs at 17 to 47 kHz, so 7 to 19 ms.
const RELOAD: u16 = 80;

/// The watchdog.
pub struct Watchdog(());

impl Watchdog {
    /// Starts it with its longest period without a prescaler: at least 4 096 * 4 / 47 kHz = 348 ms, which covers a slow
    /// crystal and the tests at power-up. It runs on while a debugger halts the processor, except in an image for
    /// debugging.
    pub fn start() -> Self {
        #[cfg(feature = "debugging")]
        freeze_with_processor();
        IWDG.kr().write(|w| w.set_key(Key::START));
        Self(())
    }

    /// Sets the shorter period for operation, before the first millisecond.
    pub fn begin_operation(&mut self) {
        set_period(Pr::DIVIDE_BY4, RELOAD);
    }

    /// Restarts the period.
    pub fn kick(&mut self, _permission: Kick) {
        IWDG.kr().write(|w| w.set_key(Key::RESET));
    }
}

/// Runs `work` that stalls the processor for up to 4 s, such as erasing the flash that the program runs from. The longer
/// period is in effect before `work` begins, and that of before comes back afterwards: the one of the start is longer than
/// the one of operation. The coils have to be off.
pub fn with_long_period<R>(work: impl FnOnce() -> R) -> R {
    // 4 096 * 64 / 47 kHz = 5.6 s at the fastest.
    let (divider, reload) = (IWDG.pr().read().pr(), IWDG.rlr().read().rl());
    set_period(Pr::DIVIDE_BY64, 4_095);
    let result = work();
    set_period(divider, reload);
    result
}

#[cfg(feature = "debugging")]
fn freeze_with_processor() {
    #[cfg(feature = "stm32f405")]
    stm32_metapac::DBGMCU.apb1fzr().modify(|w| w.set_iwdg(true));
    #[cfg(feature = "stm32g474")]
    stm32_metapac::DBGMCU
        .apb1lfzr()
        .modify(|w| w.set_iwdg(true));
}

fn set_period(divider: Pr, reload: u16) {
    IWDG.kr().write(|w| w.set_key(Key::ENABLE));
    IWDG.pr().write(|w| w.set_pr(divider));
    IWDG.rlr().write(|w| w.set_rl(reload));
    // The registers are in the slow clock's domain: a reload before they have arrived would load the old value.
    while IWDG.sr().read().pvu() || IWDG.sr().read().rvu() {}
    IWDG.kr().write(|w| w.set_key(Key::RESET));
}
