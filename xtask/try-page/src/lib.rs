//! Builds the page that has controller and plant inside: one file, without server and network.
//!
//! `module` compiles `hitch-try-page` to WebAssembly, and `page` joins it with the scripts, styles and the section of
//! the closed loop of `hitch serve`.
#![forbid(unsafe_code)]

mod module;
mod page;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use arm_build::workspace;

/// Largest page, bytes: what a mail or a web page takes without a second thought.
const LARGEST: usize = 5_000_000;

/// A page that was built.
#[derive(Debug)]
pub struct Built {
    /// The file.
    pub path: PathBuf,
    /// Its size, bytes.
    pub bytes: usize,
    /// The part of it that is the module before its coding in base 64, bytes.
    pub module_bytes: usize,
}

/// Builds the page into a folder.
///
/// # Errors
/// If there is no compiler for WebAssembly, the module does not compile, the page is too large, or cannot be written.
pub fn build(folder: &Path) -> Result<Built> {
    let module = module::build()?;
    let page = page::page(&module)?;
    ensure!(
        page.len() <= LARGEST,
        "the page has {} bytes, and may have {LARGEST}: find what has grown",
        page.len()
    );
    let path = folder.join("index.html");
    fs::create_dir_all(folder).with_context(|| format!("can't make {}", folder.display()))?;
    fs::write(&path, &page).with_context(|| format!("can't write {}", path.display()))?;
    Ok(Built {
        path,
        bytes: page.len(),
        module_bytes: module.len(),
    })
}

/// The folder that `cargo xtask try-page` builds into.
#[must_use]
pub fn folder() -> PathBuf {
    workspace::target().join("try-page")
}
