//! TIM16, whose input can be the low-speed oscillator (RM0440, 30.6.19).

use stm32_metapac::timer::vals::{CcmrInputCcs, FilterValue};
use stm32_metapac::{RCC, TIM16};

/// `TI1SEL`: the low-speed oscillator.
const SLOW_CLOCK: u8 = 6;
/// Counts of eight periods of an oscillator of 34 and of 29.5 kHz, at 168 MHz: they fit the counter's 16 bits.
pub const COUNTS: [u32; 2] = [168_000 * 8 / 34, 168_000 * 80 / 295];

/// A captured edge.
pub struct Capture {
    /// The counter at the edge.
    pub count: u32,
    /// An edge before this one was missed.
    pub missed: bool,
}

/// Starts the timer at the undivided clock, capturing every eighth edge.
pub fn start() {
    RCC.apb2enr().modify(|w| w.set_tim16en(true));
    let _ = RCC.apb2enr().read();
    RCC.csr().modify(|w| w.set_lsion(true));
    TIM16.tisel().write(|w| w.set_tisel(0, SLOW_CLOCK));
    TIM16.arr().write(|w| w.set_arr(u16::MAX));
    TIM16.ccmr_input(0).modify(|w| {
        w.set_ccs(0, CcmrInputCcs::TI4);
        w.set_icpsc(0, 0b11);
        w.set_icf(0, FilterValue::NO_FILTER);
    });
    TIM16.ccer().modify(|w| w.set_cce(0, true));
    TIM16.cr1().modify(|w| w.set_cen(true));
}

/// The edge that was captured since the last call.
pub fn take() -> Option<Capture> {
    let status = TIM16.sr().read();
    if !status.ccif(0) {
        return None;
    }
    // Reading the value clears the flag; the flag of a missed edge is cleared by writing zero.
    let count = u32::from(TIM16.ccr(0).read().ccr());
    let missed = status.ccof(0);
    if missed {
        TIM16.sr().modify(|w| w.set_ccof(0, false));
    }
    Some(Capture { count, missed })
}

/// Counts between two edges.
pub const fn difference(count: u32, last: u32) -> u32 {
    count.wrapping_sub(last) & 0xFFFF
}
