//! The state of the registers after a reset.

use crate::part::{CAN, PWR, Part};
use crate::registers::Registers;

/// Registers that aren't zero after a reset.
pub fn reset_values(part: Part, flags: u32, registers: &mut Registers) {
    let places = part.addresses();
    let ports = match part {
        Part::Stm32f405 => [0xA800_0000, 0x0000_0280, 0],
        Part::Stm32g474 => [0xABFF_FFFF, 0xFFFF_FEBF, 0xFFFF_FFFF],
    };
    for (index, modes) in (0..).zip(ports) {
        registers.set(places.gpio + 0x400 * index, modes);
    }
    match part {
        Part::Stm32f405 => {
            registers.set(places.rcc + 0x74, flags | 0b10);
            registers.set(places.rcc, 0x83);
            registers.set(CAN, 0b10 | 1 << 16);
            // Factory value of the internal reference, at 3.3 V.
            registers.set(0x1FFF_7A28, 1_502 << 16);
        }
        Part::Stm32g474 => {
            registers.set(places.rcc + 0x94, flags);
            registers.set(places.rcc, 0x500);
            registers.set(places.rcc + 0x08, 0b01);
            registers.set(places.flash, 0x0004_0600);
            registers.set(PWR, 0x0000_0200);
            registers.set(PWR + 0x80, 1 << 8);
            registers.set(CAN + 0x18, 1);
            registers.set(0x5000_0008, 1 << 29);
            // Factory value of the internal reference, at 3.0 V.
            registers.set(0x1FFF_75A8, 1_655 << 16);
            for base in places.adc {
                registers.set(base + 8, 1 << 29);
            }
        }
    }
    registers.set(places.gpio + 0x0C, 0x6400_0000);
    registers.set(places.gpio + 0x40C, 0x0000_0100);
}
