//! The set-up of clocks, pins, timers, converters and bus, looked at each millisecond.
//!
//! Nothing but the start writes these registers. If one differs from what it was after the start, a bit has flipped or the
//! program has gone astray, and the ECU starts anew. The outputs that hardware has cut after a failure of the clock show
//! here as well.

use super::part::register_check::REGISTERS;

/// The check.
pub struct RegisterCheck {
    signature: u32,
}

impl RegisterCheck {
    /// Notes the registers as they are now.
    pub fn seal() -> Self {
        Self {
            signature: signature(),
        }
    }

    /// True if none has changed.
    pub fn holds(&self) -> bool {
        signature() == self.signature
    }
}

/// A sum in which the place of each register counts: a change of one bit always changes it.
fn signature() -> u32 {
    REGISTERS.iter().fold(0, |sum: u32, &(address, mask)| {
        // SAFETY: the registers of the list can be read without an effect.
        let word = unsafe { (address as *const u32).read_volatile() };
        (sum.rotate_left(5) ^ (word & mask)).wrapping_mul(0x0100_0193)
    })
}
