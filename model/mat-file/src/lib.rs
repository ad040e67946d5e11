//! MAT files of MATLAB as values: level 5 (versions 5 to 7, of which 7 compresses its variables), and level 4.
//!
//! [`variables`] gives each variable by its name as a [`Value`].
//!
//! Source: MathWorks, "MAT-File Format".
#![forbid(unsafe_code)]

mod level_4;
mod level_5;
mod value;

use hitch_input::file_kind;

pub use value::Value;

/// Whether a file that begins with `bytes` is of one of the levels. Level 4 has no mark: its first variable has to fit.
#[must_use]
pub fn is_one(bytes: &[u8]) -> bool {
    file_kind::is_mat(bytes) || level_4::is_one(bytes)
}

/// The variables of a file by name.
///
/// # Errors
/// What is wrong with the file.
pub fn variables(bytes: &[u8]) -> Result<Vec<(String, Value)>, String> {
    if file_kind::is_mat(bytes) {
        level_5::variables(bytes)
    } else {
        level_4::variables(bytes)
    }
}
