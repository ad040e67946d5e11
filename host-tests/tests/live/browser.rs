//! Runs a script that operates a page in a browser.

use std::path::Path;
use std::process::Command;

use host_tests::python::{environment, run, scripts};

/// What a script says that operates the page at an address, with these files. The pictures that it takes are kept in the
/// target folder.
///
/// # Panics
/// If there is no browser, or the script fails.
pub fn operate(script: &str, page: &str, files: &[&Path]) -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = environment(&scripts().join("browser.txt"), folder).unwrap();
    let mut command = Command::new(python);
    command
        .arg(scripts().join(script))
        .arg(page)
        .args(files)
        .arg("chromium")
        .arg(folder.join("pictures"))
        .env("PYTHONPYCACHEPREFIX", folder.join("python-cache"));
    run(&mut command).unwrap_or_else(|reason| panic!("{reason:#}"))
}
