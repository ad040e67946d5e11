//! A word of what the image prints.

/// A word that can be printed.
pub enum Word<'a> {
    /// Text.
    Text(&'a str),
    /// A number.
    Number(u32),
}
