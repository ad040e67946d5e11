//! The end of a file of version 3, whose blocks of data state no length: it follows from the number of samples.

use std::collections::HashSet;

use falcon_mdf::io::ByteSource as _;

use crate::{HEADER, Recording};

/// Byte offset of the number of samples in the block of a group of channels.
const SAMPLES: u64 = 22;

impl Recording {
    /// Corrects the end, for groups of data with records of one kind; whether any is described.
    pub(crate) fn end_v3(&mut self, is_big_endian: bool) -> bool {
        let word = |file: &Self, at: u64, size: usize| -> Option<u64> {
            let mut bytes = file.read_bytes(at, size).ok()?.into_owned();
            if !is_big_endian {
                bytes.reverse();
            }
            Some(
                bytes
                    .iter()
                    .fold(0, |sum, byte| sum << 8 | u64::from(*byte)),
            )
        };
        let mut link = HEADER + 4;
        let mut group = 0;
        let mut seen = HashSet::new();
        while let Some(at) = word(self, link, 4).filter(|at| *at > 0 && seen.insert(*at)) {
            let (first, data) = (word(self, at + 8, 4), word(self, at + 16, 4));
            let sizes = first.and_then(|of| Some((of, word(self, of + 20, 2)?)));
            let head = sizes.and_then(|(of, size)| Some((of, size, word(self, of + SAMPLES, 4)?)));
            let (Some((of, size, samples)), Some(data)) = (head, data) else {
                self.correct(link, vec![0; 4]);
                self.is_cut_off = true;
                return group > 0;
            };
            let (groups, marks) = (word(self, at + 20, 2), word(self, at + 22, 2));
            let whole = self.len().saturating_sub(data) / (size + marks.unwrap_or(0)).max(1);
            let next = word(self, at + 4, 4);
            let is_open = self.is_unfinished && samples == 0 && next == Some(0);
            if groups == Some(1) && (whole < samples || is_open) {
                let whole = u32::try_from(whole).unwrap_or(u32::MAX);
                let bytes = if is_big_endian {
                    whole.to_be_bytes()
                } else {
                    whole.to_le_bytes()
                };
                self.cut(group, of + SAMPLES, bytes.to_vec());
            }
            (group, link) = (group + 1, at + 4);
        }
        true
    }
}
