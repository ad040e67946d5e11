//! The value of a variable or of a field.

/// Most numbers of a file: as text they would fill the longest file that is read.
pub const MOST_NUMBERS: usize = 64 << 20;

/// A value of a variable or of a field.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Numbers, column by column.
    Numbers {
        /// Rows, and columns of all further dimensions together.
        size: [usize; 2],
        /// The values.
        values: Vec<f64>,
    },
    /// Characters.
    Text(String),
    /// Structs with the same fields: one, or an array of them.
    Structs(Vec<Vec<(String, Value)>>),
    /// An object of a class, which only MATLAB can read.
    Object,
    /// Anything else.
    Other,
}
