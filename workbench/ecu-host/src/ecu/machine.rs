//! Runs the ECU's application: in the emulator, or on the host.

use std::io;

use hitch_ecu::link::Reply;
use hitch_ecu::{BoardScaling, Contacts, HostedEcu};
use hitch_protocols::can::Frame;

use super::flash::CutFlash;

/// The reason why a machine does not answer.
#[derive(Debug, thiserror::Error)]
pub enum MachineError {
    /// The emulator has ended, with its message.
    #[error("the emulated ECU has ended: {0}")]
    Ended(String),
    /// The connection to the emulator failed.
    #[error("the emulated ECU doesn't answer: {0}")]
    Link(#[from] io::Error),
}

/// Runs the ECU's application in steps of a millisecond.
pub trait EcuMachine {
    /// One millisecond with the received frames; the ECU's frames are appended to `said`.
    ///
    /// # Errors
    /// If the machine has ended.
    fn tick(
        &mut self,
        contacts: &Contacts,
        heard: &[Frame],
        said: &mut Vec<Frame>,
    ) -> Result<Reply, MachineError>;

    /// Switches the power off and on.
    ///
    /// # Errors
    /// If the machine has ended.
    fn power_cycle(&mut self) -> Result<(), MachineError>;
}

/// Serial number of the ECU, equal to that of the emulated one.
const SERIAL_NUMBER: u32 = 1;

/// The application, compiled for the host.
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
