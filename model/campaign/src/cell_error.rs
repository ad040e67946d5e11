//! Position of a cell of a row with separators.

use hitch_input::input_error::{InputError, Position};
use hitch_input::source_file::SourceFile;

/// A fault of a cell of a row with separators.
pub fn cell_error(
    source: &SourceFile,
    row_byte: usize,
    (index, mark): (usize, char),
    what: String,
    hint: impl Into<String>,
) -> InputError {
    let Position { line, column } = source.place(row_byte);
    let row = source.text.get(row_byte..).unwrap_or_default();
    let before = cells_before(row, index, mark);
    let column = column + before;
    InputError::at(&source.path, Position { line, column }, what, hint)
}

/// Number of characters of a row before its cell `index`.
fn cells_before(row: &str, index: usize, mark: char) -> usize {
    let (mut quoted, mut marks) = (false, 0);
    if mark == ' ' {
        // Several spaces are one separator.
        let cell = row.split_whitespace().nth(index).unwrap_or_default();
        let byte = (cell.as_ptr() as usize).checked_sub(row.as_ptr() as usize);
        let before = byte.and_then(|byte| row.get(..byte)).unwrap_or_default();
        return before.chars().count();
    }
    for (characters, c) in row.chars().enumerate() {
        if marks == index {
            return characters;
        }
        match c {
            '"' => quoted = !quoted,
            c if c == mark && !quoted => marks += 1,
            '\n' | '\r' if !quoted => return characters,
            _ => {}
        }
    }
    row.chars().count()
}
