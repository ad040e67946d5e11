//! Output of the program: texts on standard output, JSON documents, files that are written atomically, progress, and errors with their exit
//! codes.
#![forbid(unsafe_code)]

pub mod archive;
mod document;
pub mod error;
pub mod progress;
pub mod targets;
pub mod text;

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;

use crate::error::Error;

pub use document::Document;

/// Prints a text on standard output; without its colours where it is not a terminal, or `NO_COLOR` is set.
///
/// # Errors
/// If standard output is closed or full.
pub fn print(text: &str) -> Result<(), Error> {
    let mut out = anstream::stdout().lock();
    out.write_all(text.as_bytes())
        .and_then(|()| out.flush())
        .map_err(Error::Stdout)
}

fn print_bytes(bytes: &[u8]) -> Result<(), Error> {
    let mut out = io::stdout().lock();
    out.write_all(bytes)
        .and_then(|()| out.flush())
        .map_err(Error::Stdout)
}

/// Target of a command's JSON document.
#[derive(Debug, Clone, clap::Args)]
pub struct JsonArg {
    /// Print the result as one JSON document: `-` on standard output (and nothing else there), or to a file
    #[arg(long = "json", value_name = "FILE")]
    target: Option<PathBuf>,
}

impl JsonArg {
    /// The target, if given.
    #[must_use]
    pub fn target(&self) -> Option<&Path> {
        self.target.as_deref()
    }

    /// Writes a result as JSON if a target is given.
    ///
    /// # Errors
    /// If the target cannot be written.
    pub fn write<T: Serialize>(&self, result: &T) -> Result<(), Error> {
        let Some(path) = &self.target else {
            return Ok(());
        };
        write_file(path, Document::of(result).pretty()?.as_bytes())
    }
}

/// Whether a name means standard output.
#[must_use]
pub fn is_stdout(path: &Path) -> bool {
    path == Path::new("-")
}

/// Rejects `-` (standard output) for an option that cannot use it.
///
/// # Errors
/// If the name is `-`; `why` is the reason in the message.
pub fn no_stdout(option: &str, path: Option<&Path>, why: &str) -> Result<(), Error> {
    if path.is_some_and(is_stdout) {
        Err(Error::Usage(format!("{option} -: {why}; give a file")))
    } else {
        Ok(())
    }
}

/// Checks that a file can be written, before a long computation starts.
///
/// # Errors
/// If the folder does not exist or is not writable, or the name is that of a folder.
pub fn check_writable(path: &Path) -> Result<(), Error> {
    if is_stdout(path) || (path.exists() && !path.is_file() && !path.is_dir()) {
        return Ok(());
    }
    check_name(path).map_err(Error::writing(path))?;
    // The temporary file is deleted at once.
    let temporary = temporary_file(folder_of(path));
    temporary.map(drop).map_err(Error::writing(path))
}

/// The first of names without end that is free.
pub fn first_free(
    mut names: impl Iterator<Item = String>,
    mut is_taken: impl FnMut(&str) -> bool,
) -> String {
    names.find(|name| !is_taken(name)).unwrap_or_default()
}

/// Checks that a folder is writable, or can be created.
///
/// # Errors
/// If the nearest existing folder of that path is not writable.
pub fn check_folder(path: &Path) -> Result<(), Error> {
    let there = path.ancestors().find(|folder| folder.exists());
    let folder = there.unwrap_or(Path::new("."));
    let temporary = temporary_file(folder);
    temporary.map(drop).map_err(Error::writing(path))
}

/// Checks that a folder of results is new and can be written.
///
/// # Errors
/// If its name means standard output, it has files already, or it cannot be written; `option` is named in the message.
pub fn check_new_folder(option: &str, path: &Path) -> Result<(), Error> {
    no_stdout(option, Some(path), "the result is a folder")?;
    let has_files = fs::read_dir(path).is_ok_and(|mut files| files.next().is_some());
    if has_files || path.is_file() {
        return Err(Error::Usage(format!(
            "{}: exists already, and is not overwritten; give a new folder",
            path.display()
        )));
    }
    check_folder(path)
}

/// Creates a folder and those above it, unless they exist.
///
/// # Errors
/// If one cannot be created.
pub fn create_folder(path: &Path) -> Result<(), Error> {
    fs::create_dir_all(path).map_err(Error::writing(path))
}

/// Checks a name for a file.
fn check_name(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Err(io::Error::other("it is a folder"));
    }
    if path.file_name().is_none() || !folder_of(path).is_dir() {
        return Err(io::Error::other("its folder does not exist"));
    }
    Ok(())
}

/// Writes a file atomically: as a temporary file beside it, then renamed; `-` is standard output.
///
/// # Errors
/// If the file cannot be written; the old file is then unchanged.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    if is_stdout(path) {
        return print_bytes(bytes);
    }
    let fault = Error::writing(path);
    check_name(path).map_err(&fault)?;
    if path.exists() && !path.is_file() {
        // A device or a pipe is written in place: a rename would replace it.
        return fs::write(path, bytes).map_err(fault);
    }
    let mut beside = temporary_file(folder_of(path)).map_err(&fault)?;
    beside
        .write_all(bytes)
        .and_then(|()| beside.flush())
        .map_err(&fault)?;
    beside.persist(path).map_err(|error| fault(error.error))?;
    Ok(())
}

/// Writes a text to a file, if there is one.
///
/// # Errors
/// As for [`write_file`].
pub fn write_if(path: Option<&PathBuf>, text: impl FnOnce() -> String) -> Result<(), Error> {
    path.map_or(Ok(()), |path| write_file(path, text().as_bytes()))
}

/// The name of a file without its extension, as name of its contents.
pub fn stem(path: &Path) -> String {
    let named = Some(path).filter(|path| !is_stdout(path));
    named.and_then(Path::file_stem).map_or_else(
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
    fn what_cannot_be_written_is_noticed_early_and_nothing_is_left() {
        let dir = tempfile::tempdir().unwrap();
        assert!(check_writable(&dir.path().join("no/out.json")).is_err());
        assert!(check_writable(dir.path()).is_err());
        assert!(check_writable(&dir.path().join("out.json")).is_ok());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 0);
        // A folder that is not writable even for root.
        let full = Path::new("/proc");
        assert!(!full.is_dir() || check_writable(&full.join("out.json")).is_err());
    }
}
