//! TIM5, whose channel 4 can capture the low-speed oscillator (RM0090, 18.4.21).

use stm32_metapac::timer::vals::{CcmrInputCcs, FilterValue};
use stm32_metapac::{RCC, TIM5};

/// Channel 4.
const CHANNEL: usize = 3;
/// `TI4_RMP`: the low-speed oscillator.
const SLOW_CLOCK: u32 = 0b01 << 6;
/// Counts of eight periods of an oscillator of 47 and of 17 kHz, at 84 MHz.
pub const COUNTS: [u32; 2] = [84_000 * 8 / 47, 84_000 * 8 / 17];

/// A captured edge.
pub struct Capture {
    /// The counter at the edge.
    pub count: u32,
    /// An edge before this one was missed.
    pub missed: bool,
}

/// Starts the timer at the undivided clock, capturing every eighth edge.
pub fn start() {
    RCC.apb1enr().modify(|w| w.set_tim5en(true));
    let _ = RCC.apb1enr().read();
    RCC.csr().modify(|w| w.set_lsion(true));
    TIM5.or().write(|w| *w = SLOW_CLOCK);
    TIM5.arr().write_value(u32::MAX);
    TIM5.ccmr_input(1).modify(|w| {
        w.set_ccs(CHANNEL - 2, CcmrInputCcs::TI4);
        w.set_icpsc(CHANNEL - 2, 0b11);
        w.set_icf(CHANNEL - 2, FilterValue::NO_FILTER);
    });
    TIM5.ccer().modify(|w| w.set_cce(CHANNEL, true));
    TIM5.cr1().modify(|w| w.set_cen(true));
}

/// The edge that was captured since the last call.
pub fn take() -> Option<Capture> {
    let status = TIM5.sr().read();
    if !status.ccif(CHANNEL) {
        return None;
    }
    // Reading the value clears the flag; the flag of a missed edge is cleared by writing zero.
    let count = TIM5.ccr(CHANNEL).read();
    let missed = status.ccof(CHANNEL);
    if missed {
        TIM5.sr().modify(|w| w.set_ccof(CHANNEL, false));
    }
    Some(Capture { count, missed })
}

/// Counts between two edges.
pub const fn difference(count: u32, last: u32) -> u32 {
    count.wrapping_sub(last)
}
