//! The ECU on the parts of any HAL: what a new board has to provide, in one file.
//!
//! [`Outside`] and the loop in `main` are all of the port. The HAL below them stands in for that of a microcontroller, so
//! that the example runs on a computer: `cargo run -p hitch-ecu --example any_hal`. On a microcontroller `main` gets the
//! pins, the pulse widths, the converter and the CAN controller of its HAL instead, and loops for ever.

use hitch_ecu::{
    BoardScaling, CanPort, CoilDriver, Contacts, Drive, Ecu, FlashRegions, Hardware, PanelInputs,
};
use hitch_protocols::can::Frame;

/// Coils and bus: the part of a port that the application calls.
struct Outside {
    coils: CoilDriver<hal::Pwm, hal::Pwm, hal::Pin, hal::Pin>,
    can: CanPort<hal::Can>,
}

impl Hardware for Outside {
    fn drive(&mut self, drive: Drive) {
        // If an output fails, the driver has cut both coils, and its read-back reports the rest.
        let _ = self.coils.drive(drive);
    }

    fn receive(&mut self) -> Option<Frame> {
        self.can.receive()
    }

    fn send(&mut self, frame: &Frame) -> bool {
        self.can.send(frame)
    }

    fn frames_dropped(&self) -> u16 {
        self.can.dropped()
    }

    fn is_bus_off(&self) -> bool {
        self.can.driver().is_bus_off()
    }
}

fn main() {
    let line = hal::Pin::default();
    let mut outside = Outside {
        coils: CoilDriver::new(hal::Pwm, hal::Pwm, line.clone(), line),
        can: CanPort::new(hal::Can::default()),
    };
    let mut panel = PanelInputs::new(std::array::from_fn(|_| hal::Pin::open()));
    let flash = FlashRegions {
        calibration: hal::Flash::blank(),
        fault_log: hal::Flash::blank(),
        key: hal::Flash::blank(),
    };
    let mut ecu = Ecu::start(flash, hal::SERIAL_NUMBER, BoardScaling::NOMINAL);
    let mut kicks = 0;
    for millisecond in 0..hal::MILLISECONDS {
        let contacts = Contacts {
            samples: hal::conversion(),
            panel: panel.read(),
            clock_us: 1_000 * millisecond,
            enable_feedback: Some(outside.coils.enable_feedback()),
            clock_ratio: None,
        };
        // The permission is the only reason to reset the watchdog.
        kicks += u32::from(ecu.tick(&contacts, &mut outside).is_some());
    }
    let frames = outside.can.driver().sent();
    let state = ecu.outputs().state;
    println!("{state:?}; {kicks} permissions to reset the watchdog, {frames} frames sent");
    assert_eq!(
        kicks,
        hal::MILLISECONDS,
        "every task runs in every millisecond"
    );
    assert!(frames > 0, "the node claims its address");
}

/// A HAL without a microcontroller: inputs at rest, outputs that are read back, a bus without other nodes.
mod hal {
    use std::cell::Cell;
    use std::convert::Infallible;
    use std::rc::Rc;

    use embedded_hal::{digital, pwm};
    use embedded_storage::nor_flash::{ErrorType, NorFlash, ReadNorFlash};
    use hitch_ecu::{AdcCode, Samples};
    use hitch_protocols::can::Frame;

    pub const SERIAL_NUMBER: u32 = 1;
    pub const MILLISECONDS: u32 = 1_000;

    /// One conversion of all inputs: sensors in the middle of their range, coils without current.
    pub fn conversion() -> Samples {
        let middle = AdcCode::new(2_048);
        Samples {
            rocker_angle: middle,
            lever: middle,
            upper_limit: middle,
            lowering_dial: middle,
            // 12 V, 5 V and the internal band gap, in the scaling of the board.
            supply: AdcCode::new(2_000),
            sensor_supply: AdcCode::new(3_103),
            reference: super::BoardScaling::NOMINAL.reference,
            ..Samples::default()
        }
    }

    /// A pin whose clones are connected.
    #[derive(Clone, Default)]
    pub struct Pin(Rc<Cell<bool>>);

    impl Pin {
        /// An input with its pull-up, and nothing that closes to ground.
        pub fn open() -> Self {
            Self(Rc::new(Cell::new(true)))
        }
    }

    impl digital::ErrorType for Pin {
        type Error = Infallible;
    }

    impl digital::OutputPin for Pin {
        fn set_low(&mut self) -> Result<(), Infallible> {
            self.0.set(false);
            Ok(())
        }

        fn set_high(&mut self) -> Result<(), Infallible> {
            self.0.set(true);
            Ok(())
        }
    }

    impl digital::InputPin for Pin {
        fn is_high(&mut self) -> Result<bool, Infallible> {
            Ok(self.0.get())
        }

        fn is_low(&mut self) -> Result<bool, Infallible> {
            Ok(!self.0.get())
        }
    }

    /// A timer's output.
    pub struct Pwm;

    impl pwm::ErrorType for Pwm {
        type Error = Infallible;
    }

    impl pwm::SetDutyCycle for Pwm {
        fn max_duty_cycle(&self) -> u16 {
            super::BoardScaling::NOMINAL.pwm_steps
        }

        fn set_duty_cycle(&mut self, _: u16) -> Result<(), Infallible> {
            Ok(())
        }
    }

    /// A CAN controller that sends at once.
    #[derive(Default)]
    pub struct Can {
        sent: u32,
    }

    impl Can {
        pub fn sent(&self) -> u32 {
            self.sent
        }

        pub fn is_bus_off(&self) -> bool {
            false
        }
    }

    impl embedded_can::nb::Can for Can {
        type Frame = Frame;
        type Error = Infallible;

        fn transmit(&mut self, _: &Frame) -> nb::Result<Option<Frame>, Infallible> {
            self.sent += 1;
            Ok(None)
        }

        fn receive(&mut self) -> nb::Result<Frame, Infallible> {
            Err(nb::Error::WouldBlock)
        }
    }

    /// Two pages of flash.
    pub struct Flash(Vec<u8>);

    impl Flash {
        pub fn blank() -> Self {
            Self(vec![0xFF; 2 * Self::ERASE_SIZE])
        }
    }

    impl ErrorType for Flash {
        type Error = Infallible;
    }

    impl ReadNorFlash for Flash {
        const READ_SIZE: usize = 1;

        fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Infallible> {
            let offset = offset as usize;
            bytes.copy_from_slice(&self.0[offset..offset + bytes.len()]);
            Ok(())
        }

        fn capacity(&self) -> usize {
            self.0.len()
        }
    }

    impl NorFlash for Flash {
        const WRITE_SIZE: usize = 8;
        const ERASE_SIZE: usize = 4_096;

        fn erase(&mut self, from: u32, to: u32) -> Result<(), Infallible> {
            self.0[from as usize..to as usize].fill(0xFF);
            Ok(())
        }

        fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Infallible> {
            let offset = offset as usize;
            self.0[offset..offset + bytes.len()].copy_from_slice(bytes);
            Ok(())
        }
    }
}
