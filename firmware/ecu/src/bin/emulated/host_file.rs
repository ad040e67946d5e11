//! Files and pipes of the machine that runs the emulator, by semihosting.

use core::ffi::CStr;

use cortex_m_semihosting::{nr, syscall};

use crate::word::Word;

/// What went wrong with a file of the host.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HostFileError {
    /// It could not be opened.
    Open(&'static str),
    /// It ended inside a record.
    Truncated,
    /// Not all bytes could be read or written where they should be.
    Access,
}

impl HostFileError {
    /// What went wrong, in words.
    pub const fn words(self) -> [Word<'static>; 3] {
        let [before, name, after] = match self {
            Self::Open(name) => ["can't open the host's `", name, "`\n"],
            Self::Truncated => ["the input ends inside a record", "", "\n"],
            Self::Access => [
                "can't read or write on the host: ",
                "is its disk full, or the reader gone?",
                "\n",
            ],
        };
        [Word::Text(before), Word::Text(name), Word::Text(after)]
    }
}

/// An open file; the host closes it when the emulator ends.
#[derive(Clone, Copy)]
pub struct HostFile {
    handle: usize,
}

impl HostFile {
    /// The emulator's standard input.
    pub fn input() -> Result<Self, HostFileError> {
        Self::open(c"/dev/stdin", nr::open::R_BINARY)
    }

    /// The emulator's standard output.
    pub fn output() -> Result<Self, HostFileError> {
        Self::open(c"/dev/stdout", nr::open::W_APPEND_BINARY)
    }

    /// Opens a file that exists for reading and writing, anywhere in it.
    pub fn open_for_both(name: &'static CStr) -> Result<Self, HostFileError> {
        Self::open(name, nr::open::RW_BINARY)
    }

    /// The emulator's standard error.
    pub fn console() -> Result<Self, HostFileError> {
        Self::open(c"/dev/stderr", nr::open::W_APPEND)
    }

    fn open(name: &'static CStr, mode: usize) -> Result<Self, HostFileError> {
        let block = [name.as_ptr() as usize, mode, name.count_bytes()];
        // SAFETY: SYS_OPEN takes the address of a C string, a mode and the string's length, all alive during the call.
        match unsafe { syscall(nr::OPEN, &block) } {
            usize::MAX => Err(HostFileError::Open(name.to_str().unwrap_or("?"))),
            handle => Ok(Self { handle }),
        }
    }

    /// Reads what there is, waiting until there is something; 0 at the end.
    pub fn read(&mut self, target: &mut [u8]) -> usize {
        let block = [self.handle, target.as_mut_ptr() as usize, target.len()];
        // SAFETY: SYS_READ takes a handle that SYS_OPEN gave and a buffer that it may fill.
        let missing = unsafe { syscall(nr::READ, &block) };
        target.len().saturating_sub(missing)
    }

    /// Writes all of `bytes`.
    pub fn write_all(&mut self, bytes: &[u8]) -> Result<(), HostFileError> {
        let block = [self.handle, bytes.as_ptr() as usize, bytes.len()];
        // SAFETY: SYS_WRITE takes a handle that SYS_OPEN gave and a buffer that it only reads.
        match unsafe { syscall(nr::WRITE, &block) } {
            0 => Ok(()),
            _ => Err(HostFileError::Access),
        }
    }

    /// Goes to a place in the file.
    pub fn seek(&mut self, offset: usize) -> Result<(), HostFileError> {
        // SAFETY: SYS_SEEK takes a handle that SYS_OPEN gave and a number.
        match unsafe { syscall(nr::SEEK, &[self.handle, offset]) } {
            0 => Ok(()),
            _ => Err(HostFileError::Access),
        }
    }
}
