//! Temporary folders of the server and of its uploads.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use axum::http::StatusCode;
use tempfile::TempDir;

use super::limits::{LONGEST_NAME, MOST_BYTES, MOST_FILES};
use super::proposal::Proposal;
use crate::guard::random_token;
use crate::refusal::Refusal;
use hitch_output::error::Error;

/// The folder of all uploads of a server; it exists only if there was an upload.
#[derive(Debug, Default)]
pub struct Folders {
    state: Mutex<State>,
}

#[derive(Debug, Default)]
struct State {
    root: Option<TempDir>,
    is_closed: bool,
}

/// The files of an upload.
#[derive(Debug)]
pub struct Upload {
    /// Its id.
    pub id: String,
    folder: TempDir,
    received: Mutex<Received>,
    /// The proposed assignment, once all files are there.
    pub proposal: Mutex<Option<Proposal>>,
}

/// Files that were received or are being received.
#[derive(Debug, Default)]
pub(super) struct Received {
    /// Name of each file, and whether it is complete.
    files: Vec<(String, bool)>,
    bytes: u64,
}

impl Folders {
    /// Starts an upload.
    ///
    /// # Errors
    /// If the temporary folder cannot be created, or the server stops.
    pub fn begin(&self) -> Result<Upload, Error> {
        let fault = |error: io::Error| {
            Error::Failed(format!("no temporary folder can be created: {error}"))
        };
        let mut state = self.state();
        if state.is_closed {
            return Err(Error::Failed("the server stops".to_owned()));
        }
        let root = match state.root.take() {
            Some(root) => root,
            None => private("hitch-", None).map_err(fault)?,
        };
        let folder = private("upload-", Some(root.path())).map_err(fault);
        state.root = Some(root);
        Ok(Upload {
            id: random_token(),
            folder: folder?,
            received: Mutex::default(),
            proposal: Mutex::default(),
        })
    }

    /// Deletes all files; there are no uploads afterwards.
    pub fn close(&self) {
        /// Attempts: a file that is being written may appear while its folder is deleted.
        const ATTEMPTS: u32 = 10;
        let mut state = self.state();
        state.is_closed = true;
        let Some(root) = state.root.take() else {
            return;
        };
        for _ in 0..ATTEMPTS {
            let deleted = fs::remove_dir_all(root.path());
            if deleted.is_ok() || !root.path().exists() {
                return;
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        eprintln!(
            "hitch: {}: cannot be deleted; delete it by hand",
            root.path().display()
        );
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A folder that only its user can read.
fn private(prefix: &str, parent: Option<&Path>) -> io::Result<TempDir> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(prefix);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
    match parent {
        Some(parent) => builder.tempdir_in(parent),
        None => builder.tempdir(),
    }
}

impl Upload {
    /// The folder of its files.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    pub(super) fn received(&self) -> MutexGuard<'_, Received> {
        self.received.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The files, in the order of their names; `None` while one of them is being received.
    pub fn files(&self) -> Option<Vec<PathBuf>> {
        let received = self.received();
        let mut names = Vec::with_capacity(received.files.len());
        for (name, is_complete) in &received.files {
            names.push(is_complete.then_some(name.as_str())?);
        }
        names.sort_unstable();
        let files = names.iter().map(|name| self.path().join(name));
        Some(files.collect())
    }
}

impl Received {
    /// Registers a file.
    ///
    /// # Errors
    /// If the name is taken, or there are too many files.
    pub fn reserve(&mut self, name: &str) -> Result<(), Refusal> {
        if self.files.len() >= MOST_FILES {
            return Err(too_much());
        }
        // Some file systems do not distinguish case.
        let folded = name.to_lowercase();
        let mut known = self.files.iter();
        if known.any(|(other, _)| other.to_lowercase() == folded) {
            return Err(Refusal::wrong(format!(
                "{name:?}: there is another file with this name; rename one of them"
            )));
        }
        self.files.push((name.to_owned(), false));
        Ok(())
    }

    /// Counts received bytes.
    ///
    /// # Errors
    /// If they exceed the limit; they are not counted then.
    pub fn grow(&mut self, bytes: u64) -> Result<(), Refusal> {
        let sum = self.bytes.saturating_add(bytes);
        if sum > MOST_BYTES {
            return Err(too_much());
        }
        self.bytes = sum;
        Ok(())
    }

    /// Marks a file as complete.
    pub fn complete(&mut self, name: &str) {
        for (known, is_complete) in &mut self.files {
            *is_complete |= known == name;
        }
    }

    /// Removes a file that was not received completely.
    pub fn forget(&mut self, name: &str, bytes: u64) {
        self.files.retain(|(known, _)| known != name);
        self.bytes -= bytes;
    }
}

/// The fault of more files or bytes than a page opens.
pub fn too_much() -> Refusal {
    let what = format!(
        "the page opens at most {MOST_FILES} files of together {} MiB; use hitch import for more",
        MOST_BYTES >> 20
    );
    Refusal::of(StatusCode::PAYLOAD_TOO_LARGE, &what)
}

/// The name of a file without folders.
///
/// # Errors
/// If it is not the name of a file.
pub fn plain_name(given: &str) -> Result<&str, Refusal> {
    let name = given.rsplit(['/', '\\']).next().unwrap_or_default();
    let is_odd = |letter: char| letter.is_control() || letter == ':';
    if name.trim_matches(['.', ' ']).is_empty() || name.chars().any(is_odd) {
        return Err(Refusal::wrong(format!(
            "{given:?} is not the name of a file; rename it"
        )));
    }
    if name.len() > LONGEST_NAME {
        return Err(Refusal::wrong(format!(
            "the name of a file has {} bytes; at most {LONGEST_NAME} are possible",
            name.len()
        )));
    }
    Ok(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lose_their_folders() {
        for (given, name) in [
            ("monday.csv", "monday.csv"),
            ("logs/monday.csv", "monday.csv"),
            ("../../etc/passwd", "passwd"),
            ("C:\\logs\\Montag heben.csv", "Montag heben.csv"),
            ("..\\..\\monday.mf4", "monday.mf4"),
            ("/etc/hosts", "hosts"),
        ] {
            assert_eq!(plain_name(given), Ok(name), "{given}");
        }
        let long = "x".repeat(LONGEST_NAME + 1);
        for given in ["", ".", "..", "a/..", "logs/", "a\0b", "a\nb", "c:", &long] {
            assert!(plain_name(given).is_err(), "{given:?}");
        }
    }

    #[test]
    fn sizes_and_numbers_are_limited() {
        let mut received = Received::default();
        assert!(received.grow(MOST_BYTES).is_ok());
        assert_eq!(received.grow(1), Err(too_much()));
        for number in 0..MOST_FILES {
            assert!(received.reserve(&format!("{number}.csv")).is_ok());
        }
        assert_eq!(received.reserve("more.csv"), Err(too_much()));
        received.forget("0.csv", 10);
        let taken = received.reserve("1.CSV").unwrap_err();
        assert_eq!(taken.status, StatusCode::UNPROCESSABLE_ENTITY);
        assert!(received.grow(10).is_ok() && received.reserve("more.csv").is_ok());
    }

    #[test]
    fn closing_deletes_every_file() {
        let folders = Folders::default();
        let upload = folders.begin().unwrap();
        let file = upload.path().join("a.csv");
        fs::write(&file, "1").unwrap();
        let other = folders.begin().unwrap();
        let folder = other.path().to_path_buf();
        drop(other);
        assert!(file.exists() && !folder.exists());
        folders.close();
        assert!(!file.exists() && !upload.path().exists());
        assert!(folders.begin().is_err());
    }
}
