//! A word of what the image prints.

/// What can be said.
pub enum Word<'a> {
    /// Text.
    Text(&'a str),
    /// A number.
    Number(u32),
}
