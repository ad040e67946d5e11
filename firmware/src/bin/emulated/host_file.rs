//! Files and pipes of the machine that runs the emulator, by semihosting.

use core::ffi::CStr;
use core::fmt;

use cortex_m_semihosting::{nr, syscall};

/// What went wrong with a file of the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HostFileError {
    /// It could not be opened.
    Open,
    /// It ended inside a record.
    Truncated,
    /// Not all bytes could be written.
    Write,
}

impl fmt::Display for HostFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Open => "can't open a host file: the emulator must run where `inputs` is and `outputs` may be made",
            Self::Truncated => "`inputs` ends inside a record: its length must be a multiple of the record's",
            Self::Write => "can't write all bytes to the host: is its disk full, or the reader gone?",
        })
    }
}

/// An open file; the host closes it when the emulator ends.
pub struct HostFile {
    handle: usize,
}

impl HostFile {
    /// Opens `name` in the emulator's working directory for reading; a named pipe is as good as a file.
    pub fn open_for_reading(name: &CStr) -> Result<Self, HostFileError> {
        Self::open(name, nr::open::R_BINARY)
    }

    /// Creates or empties `name` in the emulator's working directory for writing.
    pub fn open_for_writing(name: &CStr) -> Result<Self, HostFileError> {
        Self::open(name, nr::open::W_TRUNC_BINARY)
    }

    /// The emulator's console.
    pub fn console() -> Result<Self, HostFileError> {
        Self::open(c":tt", nr::open::W_TRUNC)
    }

    fn open(name: &CStr, mode: usize) -> Result<Self, HostFileError> {
        let block = [name.as_ptr() as usize, mode, name.count_bytes()];
        // SAFETY: SYS_OPEN takes the address of a C string, a mode and the string's length, all alive during the call.
        match unsafe { syscall(nr::OPEN, &block) } {
            usize::MAX => Err(HostFileError::Open),
            handle => Ok(Self { handle }),
        }
    }

    /// Fills `record`; false at the end of the file.
    pub fn read_record(&mut self, record: &mut [u8]) -> Result<bool, HostFileError> {
        let mut filled = 0;
        // A pipe may hand over a record in pieces.
        while filled < record.len() {
            let rest = &mut record[filled..];
            let block = [self.handle, rest.as_mut_ptr() as usize, rest.len()];
            // SAFETY: SYS_READ takes a handle that SYS_OPEN gave and a buffer that it may fill.
            let missing = unsafe { syscall(nr::READ, &block) };
            match rest.len().checked_sub(missing) {
                Some(0) | None => break,
                Some(read) => filled += read,
            }
        }
        match filled {
            0 => Ok(false),
            all if all == record.len() => Ok(true),
            _ => Err(HostFileError::Truncated),
        }
    }

    /// Writes all of `bytes`.
    pub fn write_all(&mut self, bytes: &[u8]) -> Result<(), HostFileError> {
        let block = [self.handle, bytes.as_ptr() as usize, bytes.len()];
        // SAFETY: SYS_WRITE takes a handle that SYS_OPEN gave and a buffer that it only reads.
        match unsafe { syscall(nr::WRITE, &block) } {
            0 => Ok(()),
            _ => Err(HostFileError::Write),
        }
    }
}

impl fmt::Write for HostFile {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.write_all(text.as_bytes()).map_err(|_| fmt::Error)
    }
}
