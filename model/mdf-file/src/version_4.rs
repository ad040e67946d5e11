//! The end of a file of version 4.

use std::collections::HashSet;

use falcon_mdf::io::ByteSource as _;

use crate::block::{Block, HEAD, LINK, number, place_of_link};
use crate::{HEADER, Recording};

/// Byte offset of the number of samples in the block of a group of channels.
const SAMPLES: u64 = HEAD + 6 * LINK + 8;

impl Recording {
    /// Corrects the end; whether any group of data is described.
    pub(crate) fn end_v4(&mut self) -> bool {
        let mut link = place_of_link(HEADER, 0);
        let mut group = 0;
        let mut seen = HashSet::new();
        let mut last_data = None;
        while let Some(at) = number(self, link).filter(|at| *at > 0 && seen.insert(*at)) {
            let Some(samples) = self.end_of_group(group, at, &mut seen, &mut last_data) else {
                self.correct(link, vec![0; 8]);
                self.is_cut_off = true;
                return group > 0;
            };
            if self.is_unfinished || self.shortened.contains(&group) {
                // Without a stated number of samples it follows from the data.
                let places = samples.into_iter().map(|at| at + SAMPLES);
                places.for_each(|at| self.correct(at, vec![0; 8]));
            }
            (group, link) = (group + 1, place_of_link(at, 0));
        }
        let unfinished = last_data.filter(|_| self.is_unfinished);
        if let Some((group, at)) = unfinished.filter(|(_, at)| self.is_last(*at, &seen)) {
            let length = self.len() - at;
            self.cut(group, at + 8, length.to_le_bytes().to_vec());
        }
        true
    }

    /// Whether data at `at` without a length are the last block.
    fn is_last(&self, at: u64, seen: &HashSet<u64>) -> bool {
        let is_empty = number(self, at + 8).is_some_and(|length| length <= HEAD);
        is_empty && seen.iter().all(|other| *other <= at)
    }

    /// Corrects a group of data; the blocks of its groups of channels, or `None` if its description is not whole.
    fn end_of_group(
        &mut self,
        group: usize,
        at: u64,
        seen: &mut HashSet<u64>,
        last_data: &mut Option<(usize, u64)>,
    ) -> Option<Vec<u64>> {
        let mut of_channels = Vec::new();
        let mut blocks = vec![Block::at(self, at)?];
        while let Some(block) = blocks.pop() {
            if block.kind == *b"##CG" {
                of_channels.push(block.at);
            }
            if block.is_data() {
                *last_data = (*last_data).max(Some((group, block.at)));
            }
            let is_root = block.at == at;
            for (index, &target) in block.links.iter().enumerate().skip(is_root.into()) {
                if target == 0 || !seen.insert(target) {
                    continue;
                }
                let left = self.len().saturating_sub(target);
                match Block::at(self, target) {
                    Some(next) if next.is_data() && next.length > left => {
                        self.cut(group, target + 8, left.to_le_bytes().to_vec());
                    }
                    Some(next) if next.length <= left => blocks.push(next),
                    _ if block.leads_to_data(index) => {
                        self.cut(group, place_of_link(block.at, index), vec![0; 8]);
                    }
                    _ => return None,
                }
            }
        }
        Some(of_channels)
    }
}
