//! The emulator's console: words and numbers.
//!
//! Not by `core::fmt`, whose calls by address, of itself among others, would leave the image without a bound of its
//! stack.

use crate::host_file::{HostFile, HostFileError};
use crate::word::Word;

/// Digits of the largest number.
const MOST_DIGITS: usize = 10;

/// Says it, as far as the console takes it: nobody is left to tell if that fails.
pub fn print(words: &[Word<'_>]) {
    if let Ok(mut console) = HostFile::console() {
        let _ = words.iter().try_for_each(|word| write(&mut console, word));
    }
}

fn write(console: &mut HostFile, word: &Word<'_>) -> Result<(), HostFileError> {
    match word {
        Word::Text(text) => console.write_all(text.as_bytes()),
        Word::Number(number) => {
            let mut digits = [b'0'; MOST_DIGITS];
            let (mut rest, mut first) = (*number, MOST_DIGITS - 1);
            for (place, digit) in digits.iter_mut().enumerate().rev() {
                *digit += (rest % 10) as u8;
                if rest > 0 {
                    first = place;
                }
                rest /= 10;
            }
            console.write_all(digits.get(first..).unwrap_or_default())
        }
    }
}
