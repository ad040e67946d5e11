//! The whole way on the page of `hitch serve` in a browser: first model, constants, tuning, saved files.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.
use std::path::Path;
use std::process::Command;

use host_tests::page_server::PageServer;
use host_tests::python::{environment, run, scripts};
use tempfile::TempDir;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn the_way_is_gone_without_the_command_line() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = environment(&scripts().join("browser.txt"), folder).unwrap();
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let mut command = Command::new(python);
    command
        .arg(scripts().join("way_in_browser.py"))
        .arg(&server.page)
        .arg("chromium")
        .arg(folder.join("pictures"))
        .env("PYTHONPYCACHEPREFIX", folder.join("python-cache"));
    let said = run(&mut command).unwrap_or_else(|reason| panic!("{reason:#}"));
    assert!(said.contains("the way went well"), "{said}");
}
