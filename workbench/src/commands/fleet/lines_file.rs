//! The file of lines: each line is written at once and whole.

use std::collections::HashMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use super::line;
use hitch_output::error::Error;
use hitch_output::is_stdout;

/// An open file of lines, or standard output.
#[derive(Debug)]
pub struct LinesFile {
    path: PathBuf,
    /// `None` is standard output.
    file: Option<Mutex<File>>,
}

impl LinesFile {
    /// Opens the file, with the campaigns of its lines and whether they failed.
    ///
    /// # Errors
    /// If it has lines that are not to be continued, is not a file of lines, or cannot be read or written.
    pub fn open(path: &Path, resume: bool) -> Result<(Self, HashMap<String, bool>), Error> {
        if is_stdout(path) {
            hitch_output::no_stdout(
                "--resume with --jsonl",
                resume.then_some(path),
                "standard output has no earlier lines",
            )?;
            let lines = Self {
                path: path.to_path_buf(),
                file: None,
            };
            return Ok((lines, HashMap::new()));
        }
        let fault = Error::writing(path);
        let is_file = path.is_file();
        let text = if is_file {
            fs::read_to_string(path).map_err(&fault)?
        } else {
            String::new()
        };
        if !resume && !text.is_empty() {
            return Err(Error::Usage(format!(
                "{}: exists; continue it with --resume, delete it, or give another file",
                path.display()
            )));
        }
        let earlier = earlier(path, &text)?;
        let mut options = OpenOptions::new();
        let file = options
            .create(true)
            .append(true)
            .open(path)
            .map_err(&fault)?;
        if is_file {
            // An interrupted call may have left the start of a line.
            let whole = text.rfind('\n').map_or(0, |at| at + 1);
            if whole < text.len() {
                file.set_len(whole as u64).map_err(fault)?;
            }
        }
        let lines = Self {
            path: path.to_path_buf(),
            file: Some(Mutex::new(file)),
        };
        Ok((lines, earlier))
    }

    /// Writes a line, which ends with a line feed.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn write(&self, line: &str) -> Result<(), Error> {
        let Some(file) = &self.file else {
            return hitch_output::print(line);
        };
        let mut file = file.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        file.write_all(line.as_bytes())
            .and_then(|()| file.flush())
            .map_err(Error::writing(&self.path))
    }
}

/// The campaigns of whole lines, and whether they failed.
fn earlier(path: &Path, text: &str) -> Result<HashMap<String, bool>, Error> {
    let whole = text.rfind('\n').map_or("", |at| &text[..at]);
    let numbered = whole.lines().enumerate();
    numbered
        .map(|(index, line)| {
            line::read(line).ok_or_else(|| {
                Error::Usage(format!(
                    "{}:{}: is not a line of --jsonl; delete the line, or give another file",
                    path.display(),
                    index + 1
                ))
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_continued_after_its_last_whole_line() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("out.jsonl");
        let whole = "{\"format\":1,\"campaign\":\"a\",\"steps\":[]}\n";
        fs::write(&path, format!("{whole}{{\"format\":1,\"cam")).unwrap();
        assert!(LinesFile::open(&path, false).is_err());
        let (lines, earlier) = LinesFile::open(&path, true).unwrap();
        assert_eq!(earlier, HashMap::from([("a".to_owned(), false)]));
        lines.write("{}\n").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), format!("{whole}{{}}\n"));
        let error = LinesFile::open(&path, true).unwrap_err().to_string();
        assert!(error.contains("out.jsonl:2: "), "{error}");
    }
}
