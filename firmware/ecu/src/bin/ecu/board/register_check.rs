//! Check of the configuration of clocks, pins, timers, converters and bus, each millisecond.
//!
//! These registers are written at the start only. If one has changed, a bit has flipped or the program has failed, and
//! the ECU is reset. Outputs that hardware has switched off after a clock failure are detected here as well.

use super::part::register_check::REGISTERS;

/// The check.
pub struct RegisterCheck {
    signature: u32,
}

impl RegisterCheck {
    /// Stores the present registers.
    pub fn seal() -> Self {
        Self {
            signature: signature(),
        }
    }

    /// Whether none has changed.
    pub fn holds(&self) -> bool {
        signature() == self.signature
    }
}

/// A position-dependent checksum: a change of one bit always changes it.
fn signature() -> u32 {
    let mut sum = 0_u32;
    for &(base, offsets, mask) in REGISTERS {
        for offset in offsets {
            // SAFETY: the registers of the list can be read without side effects.
            let word = unsafe { ((base | offset) as *const u32).read_volatile() };
            sum = (sum.rotate_left(5) ^ (word & mask)).wrapping_mul(0x0100_0193);
        }
    }
    sum
}
