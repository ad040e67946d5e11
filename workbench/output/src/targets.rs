//! Output documents of a command, checked before its computation: each target has to be writable, and must not
//! overwrite an input.

use std::fs;
use std::path::{Path, PathBuf};

use hitch_campaign::Campaign;
use serde::Serialize;

use crate::error::Error;
use crate::{JsonArg, check_writable, is_stdout, print};

/// Extensions of files that a campaign is read from, beside its manifest.
const CAMPAIGN_FILES: [&str; 12] = [
    "csv", "tsv", "txt", "lvm", "log", "asc", "blf", "dbc", "mf4", "mdf", "mat", "parquet",
];

/// All documents of a command.
#[derive(Debug)]
pub struct Outputs<'a> {
    paths: Vec<&'a Path>,
}

impl<'a> Outputs<'a> {
    /// The requested documents of those that a command can write; `read` are its inputs.
    ///
    /// # Errors
    /// If a target cannot be written, or would overwrite another target or an input.
    pub fn check(
        wanted: impl IntoIterator<Item = Option<&'a Path>>,
        inputs: &[PathBuf],
    ) -> Result<Self, Error> {
        let paths: Vec<&Path> = wanted.into_iter().flatten().collect();
        for (index, path) in paths.iter().enumerate() {
            check_writable(path)?;
            let name = path.display();
            if paths[..index].iter().any(|other| is_same(path, other)) {
                return Err(Error::Usage(format!(
                    "{name}: is the target of two results; give each its own file"
                )));
            }
            if inputs.iter().any(|input| is_same(path, input)) {
                return Err(Error::Usage(format!(
                    "{name}: is an input of this command and would be overwritten; give another file"
                )));
            }
        }
        Ok(Self { paths })
    }

    /// Prints a text on standard output, unless a document is written there.
    ///
    /// # Errors
    /// If standard output is closed or full.
    pub fn say(&self, text: impl FnOnce() -> String) -> Result<(), Error> {
        if self.paths.iter().any(|path| is_stdout(path)) {
            return Ok(());
        }
        print(&text())
    }

    /// Writes a result as JSON if requested, and prints it as text.
    ///
    /// # Errors
    /// If either cannot be written.
    pub fn tell<T: Serialize>(
        &self,
        json: &JsonArg,
        result: &T,
        text: impl FnOnce() -> String,
    ) -> Result<(), Error> {
        json.write(result)?;
        self.say(text)
    }
}

/// The input files of a campaign: those in its folder, and those elsewhere that its manifest names.
pub fn campaign_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    let is_read = |path: &PathBuf| match path.extension().and_then(|end| end.to_str()) {
        Some("toml") => path.file_name().is_some_and(|name| name == "campaign.toml"),
        Some(end) => CAMPAIGN_FILES.contains(&end.to_lowercase().as_str()),
        None => false,
    };
    // A fault of the manifest is reported when the campaign is read.
    let named = Campaign::files(folder).unwrap_or_default();
    paths.filter(is_read).chain(named).collect()
}

/// Whether two names refer to the same file. A device or a pipe may be the target of several results.
fn is_same(a: &Path, b: &Path) -> bool {
    if is_stdout(a) || is_stdout(b) {
        return is_stdout(a) && is_stdout(b);
    }
    let is_file = |path: &Path| !path.exists() || path.is_file();
    is_file(a) && is_file(b) && whole(a) == whole(b)
}

/// A path without links and `..`; the file need not exist.
fn whole(path: &Path) -> PathBuf {
    let in_folder = || {
        let folder = path
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        let folder = fs::canonicalize(folder.unwrap_or(Path::new("."))).ok()?;
        Some(folder.join(path.file_name()?))
    };
    fs::canonicalize(path)
        .ok()
        .or_else(in_folder)
        .unwrap_or_else(|| path.to_path_buf())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fault(outputs: &[&Path], inputs: &[PathBuf]) -> String {
        let wanted = outputs.iter().map(|path| Some(*path));
        Outputs::check(wanted, inputs).map_or_else(|error| error.to_string(), |_| String::new())
    }

    #[test]
    fn every_result_has_a_place_of_its_own() {
        let dir = tempfile::tempdir().unwrap();
        let [a, b] = ["a.toml", "b.toml"].map(|name| dir.path().join(name));
        let detour = dir.path().join(".").join("a.toml");
        assert_eq!(fault(&[&a, &b], &[]), "");
        assert!(fault(&[&a, &detour], &[]).contains("is the target of two results"));
        fs::write(&a, "").unwrap();
        assert!(fault(&[&detour], std::slice::from_ref(&a)).contains("would be overwritten"));
        assert_eq!(fault(&[&b], &[a]), "");
        let stdout = Path::new("-");
        assert!(fault(&[stdout, stdout], &[]).contains("is the target of two results"));
        let sink = Path::new("/dev/null");
        assert!(!sink.exists() || fault(&[sink, sink], &[]).is_empty());
        assert_eq!(
            fs::read_dir(dir.path()).unwrap().count(),
            1,
            "nothing else is left"
        );
    }

    #[test]
    fn logs_that_lie_elsewhere_are_read_too() {
        let [dir, elsewhere] = [0; 2].map(|_| tempfile::tempdir().unwrap());
        let log = elsewhere.path().join("monday.txt");
        fs::write(&log, "").unwrap();
        let text = format!("[[run]]\nfile = {:?}\n", log.to_str().unwrap());
        fs::write(dir.path().join("campaign.toml"), text).unwrap();
        let read = campaign_files(dir.path());
        assert!(fault(&[&log], &read).contains("would be overwritten"));
    }

    #[test]
    fn a_campaign_is_read_from_its_manifest_and_logs() {
        let dir = tempfile::tempdir().unwrap();
        for name in [
            "campaign.toml",
            "model.toml",
            "lift.CSV",
            "bus.asc",
            "report.html",
        ] {
            fs::write(dir.path().join(name), "").unwrap();
        }
        let mut read = campaign_files(dir.path());
        read.sort();
        let names = ["bus.asc", "campaign.toml", "lift.CSV"];
        assert_eq!(read, names.map(|name| dir.path().join(name)));
    }
}
