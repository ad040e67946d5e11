//! The page of `hitch serve` as an instrument in a browser, in a small and a large window and on a phone.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.
use std::path::Path;
use std::process::Command;

use host_tests::page_server::PageServer;
use host_tests::python::{environment, run, scripts};
use tempfile::TempDir;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn plots_stay_in_view_and_follow() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = environment(&scripts().join("browser.txt"), folder).unwrap();
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let mut command = Command::new(python);
    command
        .arg(scripts().join("instrument_in_browser.py"))
        .arg(&server.page)
        .arg("chromium")
        .arg(folder.join("pictures"))
        .env("PYTHONPYCACHEPREFIX", folder.join("python-cache"));
    let said = run(&mut command).unwrap_or_else(|reason| panic!("{reason:#}"));
    println!("{said}");
    assert!(said.contains("the instrument went well"), "{said}");
}
