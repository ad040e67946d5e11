//! Writes a calibration to the ECU, and verifies the stored one.

use std::time::{Duration, Instant};

use hitch_protocols::key::Secret;
use hitch_protocols::xcp::map::CALIBRATION_BASE;
use hitch_quantities::ValidCalibration;
use hitch_quantities::calibration::calibration_words::{GROUPS, SCALARS_WORD, word_range};

use super::session::{Session, ToolError};

const WORD_BYTES: usize = 4;
/// Events: stored, and not stored.
const STORED: u8 = 0x03;
/// Timeout; erasing flash takes seconds on some parts.
const STORES_WITHIN: Duration = Duration::from_secs(15);

/// Summary of a write.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Written {
    /// Number of values of a calibration.
    pub words: usize,
    /// Number of changed values.
    pub changed: usize,
}

/// Writes changed values, requests storage, and verifies all values from flash. Nothing is written if safety values would
/// be loosened without the key.
///
/// # Errors
/// If the ECU refuses, or the stored values differ.
pub fn write_calibration(
    session: &mut Session,
    calibration: &ValidCalibration,
    key: Option<&Secret>,
) -> Result<Written, ToolError> {
    let wanted: Vec<(usize, i32)> = calibration
        .to_words()
        .into_iter()
        .enumerate()
        // Version and checksum are part of the block.
        .filter(|(index, _)| word_range(*index).is_some())
        .collect();
    let present = words(session)?;
    let differing: Vec<(usize, i32)> = wanted
        .iter()
        .filter(|(index, value)| present.get(*index) != Some(value))
        .copied()
        .collect();
    let loosened: Vec<usize> = differing
        .iter()
        .filter(|(index, value)| {
            let class = word_range(*index).map(|range| range.class);
            let present = present.get(*index).copied().unwrap_or(*value);
            class.is_some_and(|class| class.requires_key(present, *value))
        })
        .map(|(index, _)| *index)
        .collect();
    if let Some((&first, others)) = loosened.split_first() {
        let key = key.ok_or_else(|| ToolError::Loosens {
            first: name(first),
            others: others.len(),
        })?;
        session.unlock(key)?;
    }
    let mut changed = 0;
    for (index, value) in differing {
        write_word(session, index, value)?;
        changed += 1;
    }
    session.command(&[0xF9, 0x01, 0, 0])?;
    match session.event(Instant::now() + STORES_WITHIN)? {
        Some(STORED) => {}
        _ => return Err(ToolError::NotStored),
    }
    // The reference page reflects the flash.
    session.command(&[0xEB, 0x02, 0, 1])?;
    let stored = words(session)?;
    session.command(&[0xEB, 0x02, 0, 0])?;
    let same = wanted
        .iter()
        .all(|(index, value)| stored.get(*index) == Some(value));
    if same {
        Ok(Written {
            words: wanted.len(),
            changed,
        })
    } else {
        Err(ToolError::NotStored)
    }
}

/// Name of a scalar.
fn name(word: usize) -> String {
    let names = GROUPS.iter().flat_map(|group| {
        let parameters = group.parameters.iter();
        parameters.map(|parameter| format!("{}.{}", group.name, parameter.name))
    });
    let index = word.checked_sub(SCALARS_WORD);
    let named = index.and_then(|index| names.into_iter().nth(index));
    named.unwrap_or_else(|| format!("word {word}"))
}

fn write_word(session: &mut Session, index: usize, value: i32) -> Result<(), ToolError> {
    session.set_address(CALIBRATION_BASE + (WORD_BYTES * index) as u32)?;
    let [a, b, c, d] = value.to_le_bytes();
    match session.command(&[0xF0, WORD_BYTES as u8, a, b, c, d]) {
        Err(ToolError::Refused(0x22)) => Err(ToolError::OutOfRange(index)),
        other => other.map(drop),
    }
}

/// The words of the page that XCP accesses.
fn words(session: &mut Session) -> Result<Vec<i32>, ToolError> {
    let bytes = session.read(
        CALIBRATION_BASE,
        hitch_quantities::calibration::CALIBRATION_BYTES,
    )?;
    let (words, _) = bytes.as_chunks::<WORD_BYTES>();
    Ok(words.iter().map(|word| i32::from_le_bytes(*word)).collect())
}
