//! Python environments with pinned packages, created once under the target folder.

use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use hitch_quantities::crc32::Crc32;

/// Runs a command; returns its output.
///
/// # Errors
/// If it cannot be run or fails; with its output.
pub fn run(command: &mut Command) -> Result<String> {
    let output = command
        .output()
        .with_context(|| format!("can't run {command:?}"))?;
    let said =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    let said = said.concat();
    if output.status.success() {
        Ok(said)
    } else {
        bail!("{command:?}: {}\n{said}", output.status)
    }
}

/// The interpreter of an environment with just the packages of `requirements`, made in `folder` if it isn't there.
///
/// # Errors
/// If there is no Python, or a package can't be had.
pub fn environment(requirements: &Path, folder: &Path) -> Result<PathBuf> {
    let wanted =
        fs::read(requirements).with_context(|| format!("can't read {}", requirements.display()))?;
    let environment = folder.join(format!("python-{:08x}", Crc32::of(&wanted)));
    let python = environment.join("bin").join("python");
    let complete = environment.join("complete");
    // Another test program may be making it.
    fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    let lock = environment.with_extension("lock");
    let lock = File::create(&lock).with_context(|| lock.display().to_string())?;
    lock.lock().context("can't lock the Python environment")?;
    if !complete.exists() {
        run(Command::new("python3")
            .args(["-m", "venv", "--clear"])
            .arg(&environment))?;
        run(Command::new(&python)
            .args(["-m", "pip", "install", "--quiet", "--no-compile"])
            .args(["--disable-pip-version-check", "--requirement"])
            .arg(requirements))?;
        fs::write(&complete, "")?;
    }
    Ok(python)
}

/// The same below `folder`, or nothing on a machine without Python or network, except in continuous integration (`CI`
/// is set).
///
/// # Panics
/// In continuous integration, if there is none.
pub fn installed(requirements: &str, folder: &Path) -> Option<PathBuf> {
    match environment(&scripts().join(requirements), folder) {
        Ok(python) => Some(python),
        Err(reason) if std::env::var_os("CI").is_none() => {
            eprintln!("left out, for there is no Python with the packages it needs: {reason:#}");
            None
        }
        Err(reason) => panic!("no Python with the packages it needs: {reason:#}"),
    }
}

/// Where the scripts are.
#[must_use]
pub fn scripts() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("python")
}
