//! What runs the application: the emulator, or this machine.

use std::io;

use hitch_ecu::link::Reply;
use hitch_ecu::{BoardScaling, Contacts, HostedEcu};
use hitch_protocols::can::Frame;

use super::flash::CutFlash;

/// Why a machine gives no answer.
#[derive(Debug, thiserror::Error)]
pub enum MachineError {
    /// The emulator has ended, and said why.
    #[error("the emulated ECU has ended: {0}")]
    Ended(String),
    /// The emulator can't be reached.
    #[error("the emulated ECU doesn't answer: {0}")]
    Link(#[from] io::Error),
}

/// Something that runs the ECU's application, a millisecond at a time.
pub trait EcuMachine {
    /// One millisecond with the frames that were on the bus; what the ECU said is appended to `said`.
    ///
    /// # Errors
    /// If the machine is gone.
    fn tick(
        &mut self,
        contacts: &Contacts,
        heard: &[Frame],
        said: &mut Vec<Frame>,
    ) -> Result<Reply, MachineError>;

    /// Switches the power off and on.
    ///
    /// # Errors
    /// If the machine is gone.
    fn power_cycle(&mut self) -> Result<(), MachineError>;
}

/// Serial number of the ECU, as the emulated one has it.
const SERIAL_NUMBER: u32 = 1;

/// The application compiled for this machine.
#[derive(Debug)]
pub struct OnHost {
    flash: CutFlash,
    machine: HostedEcu<CutFlash>,
}

impl OnHost {
    /// Powers it up.
    pub fn start(flash: CutFlash) -> Self {
        Self {
            machine: HostedEcu::start(flash.regions(), SERIAL_NUMBER, BoardScaling::NOMINAL),
            flash,
        }
    }

    /// The application.
    pub const fn machine(&self) -> &HostedEcu<CutFlash> {
        &self.machine
    }
}

impl EcuMachine for OnHost {
    fn tick(
        &mut self,
        contacts: &Contacts,
        heard: &[Frame],
        said: &mut Vec<Frame>,
    ) -> Result<Reply, MachineError> {
        let reply = self.machine.tick(contacts, heard);
        said.extend_from_slice(self.machine.sent());
        Ok(reply)
    }

    fn power_cycle(&mut self) -> Result<(), MachineError> {
        self.machine = HostedEcu::start(self.flash.regions(), SERIAL_NUMBER, BoardScaling::NOMINAL);
        Ok(())
    }
}
