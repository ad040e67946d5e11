//! The version of the format.

/// The supported format version.
pub const FORMAT: f64 = 1.0;
