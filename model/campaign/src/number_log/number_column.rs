//! A column of numbers in a binary file.

/// Most numbers of a file: as text they would fill the longest file that is read.
#[cfg(feature = "parquet")]
pub const MOST_NUMBERS: usize = 64 << 20;

/// A column of numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NumberColumn {
    pub name: String,
    pub unit: Option<String>,
    /// NaN where there is none.
    pub values: Vec<f64>,
    /// Its own times as logged; `None` if it has those of another column.
    pub times: Option<Vec<f64>>,
    /// Whether the file states the unit of its own times, which are in s.
    pub states_times: bool,
}

/// A fault of a file: what is wrong, and how to correct it.
pub type Fault = (String, &'static str);
