//! Recordings in MDF, versions 3 and 4 (ASAM), as the library reads them, that may be cut off or not finished by their logger:
//! what is whole is read.
//!
//! Links to data behind the end of the file are cleared, lengths of data and numbers of samples that exceed it corrected, in a
//! view of the file. A file whose description of channels stands behind its data, as asammdf saves it, needs that end.
#![forbid(unsafe_code)]

mod block;
mod version_3;
mod version_4;

use std::collections::HashSet;
use std::path::Path;
use std::sync::Arc;

use falcon_mdf::Mf4Error;
use falcon_mdf::io::{ByteSlice, ByteSource, IoBackend};

pub use block::unit_of_conversion;

/// Byte offset of the header, of the first word of the identification behind its name, and of its flags of unfinished parts.
const HEADER: u64 = 64;
const UNFINISHED: u64 = 60;

/// A file, with corrections of its end.
pub struct Recording {
    file: IoBackend,
    corrections: Vec<(u64, Vec<u8>)>,
    /// Whether its logger did not finish it.
    is_unfinished: bool,
    /// Indices of the data groups whose last records are missing.
    pub shortened: HashSet<usize>,
    /// Whether the end of the file is missing.
    pub is_cut_off: bool,
}

impl ByteSource for Recording {
    fn len(&self) -> u64 {
        self.file.len()
    }

    fn read_bytes(&self, offset: u64, len: usize) -> falcon_mdf::Result<ByteSlice<'_>> {
        let mut bytes = self.file.read_bytes(offset, len)?.into_owned();
        for (at, correct) in &self.corrections {
            for (byte, at) in correct.iter().zip(*at..) {
                let place = at.checked_sub(offset).map(|place| place as usize);
                if let Some(old) = place.and_then(|place| bytes.get_mut(place)) {
                    *old = *byte;
                }
            }
        }
        Ok(ByteSlice::Owned(bytes))
    }
}

impl Recording {
    /// Opens a file.
    ///
    /// # Errors
    /// It cannot be read, or is cut off before the description of its channels.
    pub fn open(path: &Path, is_v4: bool) -> falcon_mdf::Result<Arc<Self>> {
        let file = IoBackend::open_buffered(path)?;
        let begin = file.read_bytes(0, HEADER as usize)?.into_owned();
        let is_unfinished = begin.starts_with(b"UnFinMF ");
        let mut recording = Self {
            file,
            corrections: Vec::new(),
            is_unfinished,
            shortened: HashSet::new(),
            is_cut_off: is_unfinished,
        };
        if is_unfinished {
            // The library takes each empty block of such a file as one to the end of the file.
            recording.correct(0, b"MDF     ".to_vec());
            recording.correct(UNFINISHED, vec![0; 4]);
        }
        let is_described = if is_v4 {
            recording.end_v4()
        } else {
            recording.end_v3(begin.get(24) != Some(&0))
        };
        if is_described {
            Ok(Arc::new(recording))
        } else {
            Err(Mf4Error::parse_error(
                "the file is cut off before the description of its channels, and its samples alone have no names",
            ))
        }
    }

    fn correct(&mut self, at: u64, bytes: Vec<u8>) {
        self.corrections.push((at, bytes));
    }

    fn cut(&mut self, group: usize, at: u64, bytes: Vec<u8>) {
        self.correct(at, bytes);
        self.is_cut_off = true;
        self.shortened.insert(group);
    }
}
