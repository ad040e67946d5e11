//! Functions of the pins, whose numbers are 0 to 15.

use core::convert::Infallible;

use embedded_hal::digital::{ErrorType, InputPin, OutputPin};
use stm32_metapac::gpio::Gpio;
use stm32_metapac::gpio::vals::{Moder, Ospeedr, Pupdr};

/// A converter's input.
pub fn analog(port: Gpio, pin: usize) {
    let pin = pin & 0xF;
    port.pupdr().modify(|w| w.set_pupdr(pin, Pupdr::FLOATING));
    port.moder().modify(|w| w.set_moder(pin, Moder::ANALOG));
}

/// A peripheral's pin, by the number of its function in the data sheet.
pub fn alternate(port: Gpio, pin: usize, function: u8) {
    port.afr(pin / 8).modify(|w| w.set_afr(pin % 8, function));
    port.ospeedr()
        .modify(|w| w.set_ospeedr(pin, Ospeedr::MEDIUM_SPEED));
    port.moder().modify(|w| w.set_moder(pin, Moder::ALTERNATE));
}

/// An output, low.
pub fn output(port: Gpio, pin: usize) {
    port.bsrr().write(|w| w.set_br(pin, true));
    port.moder().modify(|w| w.set_moder(pin, Moder::OUTPUT));
}

/// A contact to ground.
pub fn input_with_pull_up(port: Gpio, pin: usize) {
    let pin = pin & 0xF;
    port.pupdr().modify(|w| w.set_pupdr(pin, Pupdr::PULL_UP));
    port.moder().modify(|w| w.set_moder(pin, Moder::INPUT));
}

/// An input driven by another circuit.
pub fn input(port: Gpio, pin: usize) {
    port.pupdr().modify(|w| w.set_pupdr(pin, Pupdr::FLOATING));
    port.moder().modify(|w| w.set_moder(pin, Moder::INPUT));
}

/// A pin that has been made an input or an output.
pub struct Pin {
    port: Gpio,
    /// Its bit in the port's registers of levels.
    bit: u32,
}

impl Pin {
    /// The pin with a number, 0 to 15, of a port.
    pub const fn new(port: Gpio, pin: usize) -> Self {
        Self {
            port,
            bit: 1 << (pin & 0xF),
        }
    }
}

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.port.bsrr().write(|w| w.0 = self.bit << 16);
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.port.bsrr().write(|w| w.0 = self.bit);
        Ok(())
    }
}

impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.port.idr().read().0 & self.bit != 0)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.is_high()?)
    }
}
