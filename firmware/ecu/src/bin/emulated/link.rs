//! Records from the host and back.
//!
//! What has come is read in one go and what was sent is written in one go, just before there is nothing more to read:
//! a host that asks record by record gets every answer at once, and one that sends a file isn't slowed down by
//! a call to it for each record.

use crate::host_file::{HostFile, HostFileError};

const BUFFER_BYTES: usize = 1_024;

/// Both directions.
pub struct Link {
    input: HostFile,
    output: HostFile,
    received: [u8; BUFFER_BYTES],
    /// Where in `heard` the next record begins, and where what has come ends.
    next: usize,
    end: usize,
    sent: heapless::Vec<u8, BUFFER_BYTES>,
}

impl Link {
    /// The emulator's standard input and output.
    pub fn open() -> Result<Self, HostFileError> {
        Ok(Self {
            input: HostFile::input()?,
            output: HostFile::output()?,
            received: [0; BUFFER_BYTES],
            next: 0,
            end: 0,
            sent: heapless::Vec::new(),
        })
    }

    /// The next record; `None` at the end.
    pub fn read<const N: usize>(&mut self) -> Result<Option<[u8; N]>, HostFileError> {
        loop {
            let waiting = self.received.get(self.next..self.end).unwrap_or_default();
            if let Some(record) = waiting.first_chunk().copied() {
                self.next += N;
                return Ok(Some(record));
            }
            let begun = waiting.len();
            self.flush()?;
            if begun > 0 {
                self.received.rotate_left(self.next.min(BUFFER_BYTES));
            }
            (self.next, self.end) = (0, begun);
            let room = self.received.get_mut(begun..).unwrap_or_default();
            match self.input.read(room) {
                0 if begun == 0 => return Ok(None),
                0 => return Err(HostFileError::Truncated),
                more => self.end += more,
            }
        }
    }

    /// Says `bytes`, now or before the next wait for the host.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), HostFileError> {
        if self.sent.extend_from_slice(bytes).is_err() {
            self.flush()?;
            return self.output.write_all(bytes);
        }
        Ok(())
    }

    fn flush(&mut self) -> Result<(), HostFileError> {
        if !self.sent.is_empty() {
            self.output.write_all(&self.sent)?;
            self.sent.clear();
        }
        Ok(())
    }
}
