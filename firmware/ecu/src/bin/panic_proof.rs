//! Proves at link time that neither the controller nor the application around it can panic.
//!
//! The panic handler calls an undefined function. If the compiler, with overflow checks on, can show that no step of
//! any controller on any inputs reaches it, and no millisecond of the application with any codes, contacts, frames and
//! flash, the handler is removed and this image links; otherwise the linker reports `the_controller_can_panic`. The
//! image is never run.

#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;

use cortex_m_rt::entry;
use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use embedded_storage::nor_flash::{ErrorType, NorFlash, NorFlashErrorKind, ReadNorFlash};
use hitch_controller::Controller;
use hitch_ecu::{
    AdcCode, BoardScaling, CoilDriver, Contacts, Drive, Ecu, FlashRegions, Hardware, Panel,
    PanelInputs, Samples,
};
use hitch_protocols::can::{ExtendedId, Frame};
use hitch_quantities::calibration::class::Fitted;
use hitch_quantities::signals::INPUT_BYTES;
use hitch_quantities::units::{MilliAmp, MilliVolt, PerMille};
use hitch_quantities::{Calibration, Inputs};

unsafe extern "C" {
    safe fn the_controller_can_panic() -> !;
}

#[entry]
fn main() -> ! {
    if black_box(true) {
        application();
    }
    // The calibration has to be opaque to the compiler: any calibration that passes validation has to be safe.
    let calibration = black_box(Calibration::nominal());
    if let Ok(calibration) = calibration.validate() {
        let mut controller = Controller::new(calibration);
        loop {
            let record = black_box([0; INPUT_BYTES]);
            black_box(controller.step(&Inputs::from_bytes(&record)).to_bytes());
        }
    }
    loop {
        black_box(());
    }
}

/// Arbitrary inputs, frames and flash contents.
fn application() {
    let scaling = black_box(BoardScaling {
        pwm_steps: 0,
        current: MilliAmp(0),
        supply: MilliVolt(0),
        signal: MilliVolt(0),
        sensor_supply: MilliVolt(0),
        reference: AdcCode::new(0),
        wire_min: PerMille(0),
        wire_max: PerMille(0),
        fitted: Fitted {
            second_track: false,
            second_contact: true,
        },
    });
    let flash = FlashRegions {
        calibration: AnyFlash,
        fault_log: AnyFlash,
        key: AnyFlash,
    };
    let mut ecu = Ecu::start(flash, black_box(0), scaling);
    let mut hardware = AnyHardware(CoilDriver::new(AnyPin, AnyPin, AnyPin, AnyPin));
    let mut panel = PanelInputs::new([AnyPin; Panel::CONTACTS.len()]);
    while black_box(true) {
        let codes = black_box([0; Samples::CHANNELS]);
        let contacts = Contacts {
            samples: Samples::from_codes(codes.map(AdcCode::new)),
            panel: panel.read(),
            clock_us: black_box(0),
            enable_feedback: black_box(true).then(|| hardware.0.enable_feedback()),
            clock_ratio: black_box(None),
        };
        black_box(ecu.tick(&contacts, &mut hardware).is_some());
    }
}

struct AnyHardware(CoilDriver<AnyPin, AnyPin, AnyPin, AnyPin>);

impl Hardware for AnyHardware {
    fn drive(&mut self, drive: Drive) {
        black_box(self.0.drive(drive).is_ok());
    }

    fn receive(&mut self) -> Option<Frame> {
        let id = ExtendedId::new(black_box(0))?;
        let data = black_box([0; Frame::MOST_BYTES]);
        Frame::data_frame(id.into(), data.get(..black_box(0))?)
    }

    fn send(&mut self, frame: &Frame) -> bool {
        black_box(*frame);
        black_box(true)
    }

    fn frames_dropped(&self) -> u16 {
        black_box(0)
    }
}

/// A pin or a PWM output that may fail.
#[derive(Clone, Copy)]
struct AnyPin;

impl digital::ErrorType for AnyPin {
    type Error = digital::ErrorKind;
}

impl OutputPin for AnyPin {
    fn set_low(&mut self) -> Result<(), digital::ErrorKind> {
        perhaps().map_err(|_| digital::ErrorKind::Other)
    }

    fn set_high(&mut self) -> Result<(), digital::ErrorKind> {
        perhaps().map_err(|_| digital::ErrorKind::Other)
    }
}

impl InputPin for AnyPin {
    fn is_high(&mut self) -> Result<bool, digital::ErrorKind> {
        perhaps().map_err(|_| digital::ErrorKind::Other)?;
        Ok(black_box(true))
    }

    fn is_low(&mut self) -> Result<bool, digital::ErrorKind> {
        self.is_high()
    }
}

impl pwm::ErrorType for AnyPin {
    type Error = pwm::ErrorKind;
}

impl SetDutyCycle for AnyPin {
    fn max_duty_cycle(&self) -> u16 {
        black_box(0)
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), pwm::ErrorKind> {
        black_box(duty);
        perhaps().map_err(|_| pwm::ErrorKind::Other)
    }
}

struct AnyFlash;

impl ErrorType for AnyFlash {
    type Error = NorFlashErrorKind;
}

/// Succeeds or fails.
fn perhaps() -> Result<(), NorFlashErrorKind> {
    if black_box(true) {
        Ok(())
    } else {
        Err(NorFlashErrorKind::Other)
    }
}

impl ReadNorFlash for AnyFlash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, _: u32, bytes: &mut [u8]) -> Result<(), NorFlashErrorKind> {
        bytes.fill_with(|| black_box(0));
        perhaps()
    }

    fn capacity(&self) -> usize {
        black_box(8_192)
    }
}

impl NorFlash for AnyFlash {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = 2_048;

    fn erase(&mut self, _: u32, _: u32) -> Result<(), NorFlashErrorKind> {
        perhaps()
    }

    fn write(&mut self, _: u32, bytes: &[u8]) -> Result<(), NorFlashErrorKind> {
        black_box(bytes);
        perhaps()
    }
}

#[panic_handler]
fn on_panic(_: &PanicInfo<'_>) -> ! {
    the_controller_can_panic()
}
