//! Everything that leaves the program: standard output, JSON documents, and files that are written whole or not at all.
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::Error;

/// Prints a text on standard output.
///
/// # Errors
/// If standard output is closed or full.
pub fn print(text: &str) -> Result<(), Error> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(Error::Stdout)
}

/// Where the JSON of a command goes.
#[derive(Debug, Clone, clap::Args)]
pub struct JsonArg {
    /// Print the result as one JSON document: `-` on standard output (and nothing else there), or to a file
    #[arg(long = "json", value_name = "FILE")]
    target: Option<PathBuf>,
}

impl JsonArg {
    /// Prints the result: as JSON where that is asked for, else (or beside a JSON file) as text.
    ///
    /// # Errors
    /// If the target cannot be written.
    pub fn print<T: Serialize>(
        &self,
        result: &T,
        text: impl FnOnce() -> String,
    ) -> Result<(), Error> {
        let Some(path) = &self.target else {
            return print(&text());
        };
        let mut document = serde_json::to_string_pretty(result).map_err(|error| {
            Error::Failed(format!("the result cannot be written as JSON: {error}"))
        })?;
        document.push('\n');
        if path == Path::new("-") {
            return print(&document);
        }
        write_file(path, document.as_bytes())?;
        print(&text())
    }

    /// Checks early that the target can be written.
    ///
    /// # Errors
    /// As [`check_writable`].
    pub fn check(&self) -> Result<(), Error> {
        check_writable(
            self.target
                .as_deref()
                .filter(|path| *path != Path::new("-")),
        )
    }
}

/// Checks that a file can be written, so that nobody waits for a result that then has nowhere to go.
///
/// # Errors
/// If its folder does not exist, or the name is a folder's.
pub fn check_writable(path: Option<&Path>) -> Result<(), Error> {
    let Some(path) = path else { return Ok(()) };
    let fault = |message: &str| {
        let source = io::Error::other(message.to_owned());
        Err(Error::Write {
            path: path.to_path_buf(),
            source,
        })
    };
    if path.is_dir() {
        return fault("it is a folder");
    }
    if path.file_name().is_none() || !folder_of(path).is_dir() {
        return fault("its folder does not exist");
    }
    Ok(())
}

/// Writes a file whole or not at all: beside it first, then in its place.
///
/// # Errors
/// If the file cannot be written; what was there before is then still there.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    check_writable(Some(path))?;
    let fault = |source: io::Error| Error::Write {
        path: path.to_path_buf(),
        source,
    };
    if path.exists() && !path.is_file() {
        // A device or a pipe: to put a file in its place would destroy it.
        return fs::write(path, bytes).map_err(fault);
    }
    let mut beside = temporary_file(folder_of(path)).map_err(fault)?;
    beside
        .write_all(bytes)
        .and_then(|()| beside.flush())
        .map_err(fault)?;
    beside.persist(path).map_err(|error| fault(error.error))?;
    Ok(())
}

/// A file's name without its extension: what it holds is called so.
pub fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(
        || "model".to_owned(),
        |stem| stem.to_string_lossy().into_owned(),
    )
}

fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// A temporary file with the permissions of an ordinary new file.
fn temporary_file(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".hitch-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_replaced_whole_and_nothing_else_is_left() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("out.json");
        write_file(&path, b"old").unwrap();
        write_file(&path, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_that_is_missing_is_noticed_early() {
        let dir = tempfile::tempdir().unwrap();
        assert!(check_writable(Some(&dir.path().join("no/out.json"))).is_err());
        assert!(check_writable(Some(dir.path())).is_err());
        assert!(check_writable(Some(Path::new("out.json"))).is_ok());
        assert!(check_writable(None).is_ok());
    }
}
