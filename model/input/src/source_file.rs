//! A text file, read completely, with its name for error messages.

use std::fs;
use std::path::{Path, PathBuf};

use crate::file_kind;
use crate::input_error::{InputError, Position};

/// Longest file, bytes: an hour at 1 kHz with eight columns is shorter.
const LONGEST_FILE_BYTES: u64 = 512 * 1024 * 1024;

/// The text of a file and its path.
#[derive(Debug, Clone)]
pub struct SourceFile {
    /// Path, as given by the user.
    pub path: PathBuf,
    /// The text, without a byte order mark.
    pub text: String,
}

impl SourceFile {
    /// Reads a UTF-8 text file; a leading byte order mark is dropped.
    ///
    /// # Errors
    /// The file is missing, not a regular file, too long, not readable or not UTF-8.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        Self::of(path, &bytes_of(path)?)
    }

    /// The text of bytes that were already read, as [`SourceFile::read`] returns it; `path` is only named in faults.
    ///
    /// # Errors
    /// The bytes are not UTF-8.
    pub fn of(path: &Path, bytes: &[u8]) -> Result<Self, InputError> {
        if is_utf16(bytes) {
            return Err(InputError::of_file(
                path,
                "is UTF-16 text",
                "save it as UTF-8",
            ));
        }
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
        match std::str::from_utf8(bytes) {
            Ok(text) => Ok(Self {
                path: path.to_path_buf(),
                text: text.to_owned(),
            }),
            Err(error) => match file_kind::of_binary(bytes) {
                Some((what, hint)) => Err(is_binary(path, what, hint)),
                None => Err(not_utf8(path, &bytes[..error.valid_up_to()])),
            },
        }
    }

    /// Reads a text file in any encoding of loggers and tools: UTF-8, UTF-16, or else Windows-1252, which accepts any
    /// bytes. A leading byte order mark is dropped.
    ///
    /// # Errors
    /// The file is missing, not a regular file, too long, not readable or not text.
    pub fn read_any(path: &Path) -> Result<Self, InputError> {
        Self::any_of(path, &bytes_of(path)?)
    }

    /// Text in any encoding, as [`SourceFile::read_any`]; `path` is its name in messages.
    ///
    /// # Errors
    /// The bytes are not text.
    pub fn any_of(path: &Path, bytes: &[u8]) -> Result<Self, InputError> {
        let binary = file_kind::of_magic(bytes).or_else(|| {
            let no_text = || file_kind::of_binary(bytes);
            (!is_utf16(bytes)).then(no_text).flatten()
        });
        match binary {
            Some((what, hint)) => Err(is_binary(path, what, hint)),
            None => Ok(Self {
                path: path.to_path_buf(),
                text: decoded(bytes),
            }),
        }
    }

    /// The bytes of a regular file of at most 512 MiB.
    ///
    /// # Errors
    /// The file is missing, not a regular file, too long or not readable.
    pub fn bytes(path: &Path) -> Result<Vec<u8>, InputError> {
        bytes_of(path)
    }

    /// A file without its text, only the name: its faults have no position.
    pub fn named(path: &Path) -> Self {
        Self {
            path: path.to_path_buf(),
            text: String::new(),
        }
    }

    /// Line and column of a byte of the text.
    pub fn place(&self, byte: usize) -> Position {
        place(&self.text, byte)
    }

    /// A fault at a byte of the text; of the whole file if there is no text.
    pub fn error_at(
        &self,
        byte: usize,
        what: impl Into<String>,
        hint: impl Into<String>,
    ) -> InputError {
        if self.text.is_empty() {
            return self.error(what, hint);
        }
        InputError::at(&self.path, self.place(byte), what, hint)
    }

    /// A fault of the whole file.
    pub fn error(&self, what: impl Into<String>, hint: impl Into<String>) -> InputError {
        InputError::of_file(&self.path, what, hint)
    }
}

/// The bytes of a regular file within the length limit.
fn bytes_of(path: &Path) -> Result<Vec<u8>, InputError> {
    let unreadable = |error: std::io::Error| unreadable(path, &error);
    let about = fs::metadata(path).map_err(unreadable)?;
    if !about.is_file() {
        let hint = "give the name of a text file";
        return Err(InputError::of_file(path, "is not a file", hint));
    }
    if about.len() > LONGEST_FILE_BYTES {
        let hint = "split the log into several runs";
        return Err(InputError::of_file(path, "is longer than 512 MiB", hint));
    }
    fs::read(path).map_err(unreadable)
}

/// Decodes bytes, without a byte order mark.
fn decoded(bytes: &[u8]) -> String {
    let encoding = if is_utf16(bytes) {
        // In mostly ASCII text, the zero byte is the high one.
        match bytes.first() {
            Some(0 | 0xFE) => encoding_rs::UTF_16BE,
            _ => encoding_rs::UTF_16LE,
        }
    } else if std::str::from_utf8(bytes).is_ok() {
        encoding_rs::UTF_8
    } else {
        encoding_rs::WINDOWS_1252
    };
    encoding.decode(bytes).0.into_owned()
}

fn is_binary(path: &Path, what: &str, hint: &str) -> InputError {
    InputError::of_file(path, format!("is {what}, not text"), hint)
}

/// Counts lines at LF, CR LF and lone CR, like the CSV reader.
fn place(text: &str, byte: usize) -> Position {
    let mut end = byte.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let before = &text[..end];
    let bytes = before.as_bytes();
    let ends_line =
        |i: usize| bytes[i] == b'\n' || (bytes[i] == b'\r' && bytes.get(i + 1) != Some(&b'\n'));
    let line_ends = (0..bytes.len()).filter(|&i| ends_line(i));
    let (count, last) = line_ends.fold((0, None), |(count, _), i| (count + 1, Some(i)));
    let start = last.map_or(0, |i| i + 1);
    Position {
        line: count + 1,
        column: before[start..].chars().count() + 1,
    }
}

fn unreadable(path: &Path, error: &std::io::Error) -> InputError {
    use std::io::ErrorKind::{NotFound, PermissionDenied};
    match error.kind() {
        NotFound => InputError::of_file(path, "no such file", "check the name"),
        PermissionDenied => InputError::of_file(path, "permission denied", "grant read permission"),
        _ => InputError::of_file(path, format!("cannot be read: {error}"), ""),
    }
}

/// Whether the bytes are UTF-16, as written by editors and spreadsheets on Windows: by the byte order mark, or by zeros
/// in every other byte of mostly ASCII text.
fn is_utf16(bytes: &[u8]) -> bool {
    const LOOKED_AT: usize = 4096;
    let begin = &bytes[..bytes.len().min(LOOKED_AT)];
    let zeros = |first: usize| {
        begin
            .iter()
            .skip(first)
            .step_by(2)
            .filter(|&&byte| byte == 0)
    };
    let (even, odd) = (zeros(0).count(), zeros(1).count());
    let half = begin.len() / 2;
    let marked = bytes.starts_with(b"\xFF\xFE") || bytes.starts_with(b"\xFE\xFF");
    marked || (half >= 4 && even.max(odd) * 10 >= half * 9 && even.min(odd) * 10 <= half)
}

fn not_utf8(path: &Path, valid: &[u8]) -> InputError {
    let text = String::from_utf8_lossy(valid);
    InputError::at(
        path,
        place(&text, text.len()),
        "is not UTF-8 text",
        "save it as UTF-8",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_decoded_from_what_loggers_write() {
        let text = "Öl [°C]\n";
        let utf16: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let cp1252 = b"\xD6l [\xB0C]\n";
        let marked = [b"\xEF\xBB\xBF", text.as_bytes()].concat();
        for bytes in [text.as_bytes(), &utf16, cp1252, &marked] {
            assert_eq!(decoded(bytes), text, "{bytes:?}");
        }
    }

    #[test]
    fn counts_lines_however_they_end() {
        let text = "a\r\nbé\nc\rd";
        assert_eq!(place(text, 0), Position { line: 1, column: 1 });
        assert_eq!(
            place(text, text.find('é').unwrap() + 2),
            Position { line: 2, column: 3 }
        );
        assert_eq!(
            place(text, text.find('c').unwrap()),
            Position { line: 3, column: 1 }
        );
        assert_eq!(
            place(text, text.find('d').unwrap()),
            Position { line: 4, column: 1 }
        );
        assert_eq!(place(text, 1000).line, 4);
    }

    #[test]
    fn utf_16_is_recognised_with_and_without_its_mark() {
        let text = "format = 1\nname = \"Größe\"\n";
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        assert!(is_utf16(&little) && is_utf16(&big));
        assert!(is_utf16(b"\xFF\xFEa\0") && is_utf16(b"\xFE\xFF\0a"));
        for other in [
            text.as_bytes(),
            b"",
            b"\0\0",
            &[0; 100],
            b"time_s\0\0\0\0\0\0",
        ] {
            assert!(!is_utf16(other), "{other:?}");
        }
    }
}
