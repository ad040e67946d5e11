//! The processor of the application, the emulator with an image or the host; and the powered ECU with its flash.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use hitch_ecu::Contacts;
use hitch_ecu::link::Reply;
use hitch_protocols::can::Frame;
use tempfile::TempDir;

use super::emulator::{Emulator, QEMU};
use super::flash::CutFlash;
use super::image;
use super::machine::{EcuMachine, MachineError, OnHost};
use hitch_output::error::Error;

/// The processor that runs the application.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Runner {
    /// The host.
    Host,
    /// The emulator, with this image.
    Emulator(PathBuf),
}

/// A powered ECU. The emulator ends when it is dropped.
#[derive(Debug)]
pub struct PoweredEcu(Kind);

#[derive(Debug)]
enum Kind {
    Host {
        cells: CutFlash,
        machine: Box<OnHost>,
    },
    Emulated {
        machine: Emulator,
        /// Has the flash of the ECU.
        folder: TempDir,
    },
}

/// File of the flash in the folder of the emulator.
const FLASH: &str = "flash";

impl Runner {
    /// The emulator with the image `given`, named by the environment, or built from the sources.
    ///
    /// # Errors
    /// If the emulator or its image is missing, with a suggested correction.
    pub fn emulator(given: Option<&Path>) -> Result<Self, Error> {
        require_emulator()?;
        Ok(Self::Emulator(image::find(given)?))
    }

    /// Powers up an ECU with these contents of its flash.
    ///
    /// # Errors
    /// If the emulator cannot be started.
    pub fn power_up(&self, flash: Vec<u8>) -> Result<PoweredEcu, MachineError> {
        let kind = match self {
            Self::Host => {
                let cells = CutFlash::holding(flash);
                let machine = Box::new(OnHost::start(cells.clone()));
                Kind::Host { cells, machine }
            }
            Self::Emulator(image) => {
                let folder = tempfile::tempdir()?;
                std::fs::write(folder.path().join(FLASH), flash)?;
                let machine = Emulator::start(image, folder.path())?;
                Kind::Emulated { machine, folder }
            }
        };
        Ok(PoweredEcu(kind))
    }
}

impl PoweredEcu {
    /// Switches the power off; the contents of the flash.
    ///
    /// # Errors
    /// If the flash of the emulator cannot be read.
    pub fn power_off(self) -> std::io::Result<Vec<u8>> {
        match self.0 {
            Kind::Host { cells, .. } => Ok(cells.bytes()),
            Kind::Emulated { machine, folder } => {
                drop(machine);
                std::fs::read(folder.path().join(FLASH))
            }
        }
    }
}

impl EcuMachine for PoweredEcu {
    fn tick(
        &mut self,
        contacts: &Contacts,
        heard: &[Frame],
        said: &mut Vec<Frame>,
    ) -> Result<Reply, MachineError> {
        match &mut self.0 {
            Kind::Host { machine, .. } => machine.tick(contacts, heard, said),
            Kind::Emulated { machine, .. } => machine.tick(contacts, heard, said),
        }
    }

    fn power_cycle(&mut self) -> Result<(), MachineError> {
        match &mut self.0 {
            Kind::Host { machine, .. } => machine.power_cycle(),
            Kind::Emulated { machine, .. } => machine.power_cycle(),
        }
    }
}

/// Adds a suggested correction if there is no emulator.
fn require_emulator() -> Result<(), Error> {
    let found = Command::new(QEMU)
        .arg("--version")
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status();
    match found {
        Ok(status) if status.success() => Ok(()),
        _ => Err(Error::Usage(format!(
            "{QEMU} is missing: install QEMU for ARM (Debian: apt-get install qemu-system-arm; macOS: brew install qemu), \
             or take --host, which runs the same application without an emulator"
        ))),
    }
}
