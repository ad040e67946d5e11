//! A line of a log, split into words with their positions.

use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;

use crate::recorded::CampaignError;

/// Largest time stamp, s: covers any date, and is still exact to a microsecond.
const LATEST_S: f64 = 1e10;

/// A word and its position in the file.
#[derive(Debug, Clone, Copy)]
pub struct Word<'a> {
    /// The word.
    pub text: &'a str,
    /// Its byte offset in the file.
    pub byte: usize,
}

/// A line with at least one word.
#[derive(Debug)]
pub struct Line<'a> {
    source: &'a SourceFile,
    words: Vec<Word<'a>>,
    /// Byte offset after the last word.
    end: usize,
    /// Whether the file ends within it.
    is_last: bool,
}

/// The non-empty lines of a file.
fn lines(source: &SourceFile) -> impl Iterator<Item = Line<'_>> {
    let mut byte = 0;
    source.text.split_inclusive('\n').filter_map(move |text| {
        let start = byte;
        byte += text.len();
        let words: Vec<Word<'_>> = text
            .split_whitespace()
            .map(|word| Word {
                text: word,
                byte: start + (word.as_ptr() as usize - text.as_ptr() as usize),
            })
            .collect();
        let last = words.last()?;
        let end = last.byte + last.text.len();
        let is_last = !text.ends_with('\n');
        Some(Line {
            source,
            words,
            end,
            is_last,
        })
    })
}

/// How the frames of a log end.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// With a whole one.
    Whole,
    /// In the middle of one, which is left out.
    CutOff,
}

/// Calls `take` for each line that is not empty. A fault of a last line without an end is that of a log that was cut off.
///
/// # Errors
/// The first fault of `take` in another line.
pub fn each_line<'s>(
    source: &'s SourceFile,
    mut take: impl FnMut(&Line<'s>) -> Result<(), CampaignError>,
) -> Result<Ending, CampaignError> {
    for line in lines(source) {
        match take(&line) {
            Err(_) if line.is_last && line.byte() > 0 => return Ok(Ending::CutOff),
            taken => taken?,
        }
    }
    Ok(Ending::Whole)
}

impl<'a> Line<'a> {
    /// Word `index`, if it exists.
    pub fn get(&self, index: usize) -> Option<Word<'a>> {
        self.words.get(index).copied()
    }

    /// The text of word `index`; empty if it does not exist.
    pub fn text(&self, index: usize) -> &'a str {
        self.get(index).map_or("", |word| word.text)
    }

    /// Number of words.
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// Byte offset of the line.
    pub fn byte(&self) -> usize {
        self.words.first().map_or(self.end, |word| word.byte)
    }

    /// Word `index`, which is required.
    pub fn word(&self, index: usize, what: &str) -> Result<Word<'a>, CampaignError> {
        self.get(index).ok_or_else(|| {
            let what = format!("the line ends before its {what}");
            let hint = "delete the truncated line";
            self.source.error_at(self.end, what, hint)
        })
    }

    /// A fault of a word, at byte `inside` of it.
    pub fn fault(&self, word: Word<'_>, inside: usize, what: &str, hint: &str) -> CampaignError {
        let what = format!("{} {what}", quote(word.text));
        self.source.error_at(word.byte + inside, what, hint)
    }

    /// The time stamp in `text`, which is a part of `word`.
    pub fn time_s(&self, word: Word<'_>, text: &str) -> Result<f64, CampaignError> {
        let time_s = text.parse().ok();
        time_s
            .filter(|time_s| (0.0..=LATEST_S).contains(time_s))
            .ok_or_else(|| self.fault(word, 0, "is not a time in seconds", "write it as 12.345678"))
    }
}
