//! Builds the side of a commit from its sources.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use arm_build::{process, workspace};

/// The crate of a side, from the root of the workspace. The present one is built with the sources of each commit.
const SIDE: &str = "xtask/replay-side";
const MEMBERS: &str = "members = [";

/// The full name of a commit of this repository.
///
/// # Errors
/// If there is no such commit.
pub fn commit(name: &str) -> Result<String> {
    let revision = format!("{name}^{{commit}}");
    let options = ["rev-parse", "--verify", "--quiet", "--end-of-options"];
    let named = process::output(process::command("git", &options).arg(revision));
    named.with_context(|| {
        format!("`{name}` is no commit of this repository; `git log --oneline` lists them")
    })
}

/// Builds the side of a commit below `folder`; the program.
///
/// # Errors
/// If the sources can't be extracted, or do not compile with the crate of the side.
pub fn build_commit(commit: &str, folder: &Path) -> Result<PathBuf> {
    let sources = folder.join(commit);
    if !sources.join("Cargo.toml").exists() {
        extract(commit, &sources)?;
    }
    let (from, to) = (workspace::root().join(SIDE), sources.join(SIDE));
    fs::create_dir_all(to.join("src"))?;
    for file in ["Cargo.toml", "build.rs"] {
        copy(&from.join(file), &to.join(file))?;
    }
    for entry in fs::read_dir(from.join("src"))? {
        let entry = entry?;
        copy(&entry.path(), &to.join("src").join(entry.file_name()))?;
    }
    let manifest = sources.join("Cargo.toml");
    let text = fs::read_to_string(&manifest).with_context(|| manifest.display().to_string())?;
    if !text.contains(SIDE) {
        ensure!(
            text.contains(MEMBERS),
            "commit {commit} has no workspace of crates; compare with a later one"
        );
        let text = text.replacen(MEMBERS, &format!("{MEMBERS}\n    \"{SIDE}\","), 1);
        fs::write(&manifest, text).with_context(|| manifest.display().to_string())?;
    }
    build(&sources, &sources.join("target"))
        .with_context(|| format!("commit {commit} has another interface than {SIDE} expects"))
}

fn copy(from: &Path, to: &Path) -> Result<()> {
    // What has not changed keeps its time, so that it is not compiled again.
    let text = fs::read(from).with_context(|| from.display().to_string())?;
    if fs::read(to).is_ok_and(|present| present == text) {
        return Ok(());
    }
    fs::write(to, text).with_context(|| to.display().to_string())
}

/// Writes the sources of a commit to a new folder.
fn extract(commit: &str, folder: &Path) -> Result<()> {
    let parts = folder.with_extension("partial");
    let _ = fs::remove_dir_all(&parts);
    fs::create_dir_all(&parts).with_context(|| parts.display().to_string())?;
    let archive = folder.with_extension("tar");
    let mut pack = process::command("git", &["archive", "--format=tar", "--output"]);
    process::run(pack.arg(&archive).arg(commit))?;
    let mut unpack = process::command("tar", &["-xf"]);
    process::run(unpack.arg(&archive).arg("-C").arg(&parts))?;
    fs::remove_file(&archive)?;
    fs::rename(&parts, folder).with_context(|| folder.display().to_string())
}

/// Builds a side; the program. Arithmetic that overflows ends it, as it does in the images.
///
/// # Errors
/// If the sources don't compile.
pub fn build(sources: &Path, target: &Path) -> Result<PathBuf> {
    let options = ["build", "--quiet", "--release", "--package", "replay-side"];
    let mut command = process::command(workspace::cargo(), &options);
    command
        .arg("--target-dir")
        .arg(target)
        .env("CARGO_PROFILE_RELEASE_OVERFLOW_CHECKS", "true")
        .env("CARGO_PROFILE_RELEASE_LTO", "off")
        .current_dir(sources);
    process::run(&mut command)?;
    Ok(target.join("release/replay-side"))
}
