//! PWM outputs for the coils, the enable line, and the trigger of the converters, from TIM1.
//!
//! ```text
//!   counter   /\    /\    /\         up and down: 2 x 5 250 steps of 168 MHz, 16 kHz
//!            /  \  /  \  /  \        output high while below the compare value
//!   update   ^ every 32nd turning point = every millisecond, in the middle between two edges:
//!              TRGO starts the injected conversions, when the coil's current passes its mean
//! ```
//!
//! One timer is the time base of everything, so the controller cannot run at a different rate than the drivers. Compare
//! values take effect at once: waiting for the next update would add a millisecond of dead time to the current
//! regulation.

use core::convert::Infallible;

use embedded_hal::pwm::{ErrorType, SetDutyCycle};
use hitch_ecu::CoilDriver;
use stm32_metapac::timer::vals::{Bkp, Cms, Mms, Ocm, Ossi};
use stm32_metapac::{DBGMCU, GPIOA, GPIOB, TIM1};

use super::part::SCALING;
use super::pins::{self, Pin};

/// Turning points of the counter in a millisecond: two per pulse, 16 pulses.
const TURNING_POINTS: u16 = 32;
/// PB10.
const ENABLE_PIN: usize = 10;
/// PB11: the enable line as the drivers see it.
const FEEDBACK_PIN: usize = 11;

/// The coil drivers of this board.
pub type Coils = CoilDriver<Channel, Channel, Pin, Pin>;

/// A PWM output of TIM1.
#[derive(Clone, Copy)]
pub enum Channel {
    /// Channel 1, on PA8.
    Lift,
    /// Channel 2, on PA9.
    Lower,
}

impl Channel {
    /// Its index in the timer's registers.
    const fn index(self) -> usize {
        match self {
            Self::Lift => 0,
            Self::Lower => 1,
        }
    }

    fn set_compare(self, value: u16) {
        TIM1.ccr(self.index()).write(|w| w.set_ccr(value));
    }
}

impl ErrorType for Channel {
    type Error = Infallible;
}

impl SetDutyCycle for Channel {
    fn max_duty_cycle(&self) -> u16 {
        SCALING.pwm_steps
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), Infallible> {
        self.set_compare(duty);
        Ok(())
    }
}

/// Outputs low, counter stopped. `function` is TIM1's alternate function on PA8 and PA9.
pub fn start(function: u8) -> Coils {
    // A debugger that halts the processor stops the timer and thereby disables its outputs.
    DBGMCU.apb2fzr().modify(|w| w.set_tim1(true));
    pins::output(GPIOB, ENABLE_PIN);
    pins::input(GPIOB, FEEDBACK_PIN);
    TIM1.arr().write(|w| w.set_arr(SCALING.pwm_steps));
    TIM1.rcr().write(|w| w.set_rep(TURNING_POINTS - 1));
    TIM1.cr1().write(|w| w.set_cms(Cms::CENTER_ALIGNED1));
    TIM1.cr2().write(|w| w.set_mms(Mms::UPDATE));
    for channel in [Channel::Lift, Channel::Lower].map(Channel::index) {
        TIM1.ccmr_output(0)
            .modify(|w| w.set_ocm(channel, Ocm::PWM_MODE1));
        TIM1.ccer().modify(|w| w.set_cce(channel, true));
    }
    // The clock security system is a break source: when the crystal fails, hardware drives the outputs to their idle
    // level, low. The pin BKIN is not used; its input is low.
    TIM1.bdtr().modify(|w| {
        w.set_bke(0, true);
        w.set_bkp(0, Bkp::ACTIVE_HIGH);
        w.set_ossi(Ossi::IDLE_LEVEL);
    });
    TIM1.bdtr().modify(|w| w.set_moe(true));
    // Loads the shadow registers.
    TIM1.egr().write(|w| w.set_ug(true));
    pins::alternate(GPIOA, 8, function);
    pins::alternate(GPIOA, 9, function);
    CoilDriver::new(
        Channel::Lift,
        Channel::Lower,
        Pin::new(GPIOB, ENABLE_PIN),
        Pin::new(GPIOB, FEEDBACK_PIN),
    )
}

/// Starts the counter, and with it the conversions.
pub fn run() {
    TIM1.cr1().modify(|w| w.set_cen(true));
}

/// Switches both coils off permanently, in any state of the program: the enable line goes low and the timer releases
/// its outputs, which pull-down resistors hold low.
pub fn cut() {
    GPIOB.bsrr().write(|w| w.set_br(ENABLE_PIN, true));
    TIM1.bdtr().modify(|w| w.set_moe(false));
    Channel::Lift.set_compare(0);
    Channel::Lower.set_compare(0);
}
