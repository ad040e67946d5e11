//! Words of the stream.

/// A signal without a value.
pub const ABSENT: i32 = i32::MIN;

/// The value of a word.
pub(crate) fn present(word: i32) -> Option<i32> {
    Some(word).filter(|word| *word != ABSENT)
}
