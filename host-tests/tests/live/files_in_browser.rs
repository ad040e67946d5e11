//! Files opened in the page of `hitch serve` in a browser, at desktop and phone widths, in light and dark theme.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.
use std::fs;
use std::path::Path;
use std::process::Command;

use host_tests::german_log::{german_log, german_log_in_volts, german_recording};
use host_tests::page_server::PageServer;
use host_tests::python::{environment, run, scripts};
use host_tests::refusal;
use tempfile::TempDir;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn a_log_of_another_logger_is_assigned_and_opened() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = environment(&scripts().join("browser.txt"), folder).unwrap();
    let dir = TempDir::new().unwrap();
    let names = ["Montag_150kg.csv", "lift.csv", "Volt_150kg.csv"];
    let [log, broken, volts] = names.map(|name| dir.path().join(name));
    fs::write(&volts, german_log_in_volts()).unwrap();
    fs::write(&log, german_log()).unwrap();
    fs::write(&broken, refusal::log().replacen("16.0", "oops", 1)).unwrap();
    let parts = ["Teil1_150kg.csv", "Teil2_150kg.csv"].map(|name| dir.path().join(name));
    for (part, text) in parts.iter().zip(german_recording()) {
        fs::write(part, text).unwrap();
    }
    let server = PageServer::start(dir.path(), &[]);
    let mut command = Command::new(python);
    command
        .arg(scripts().join("files_in_browser.py"))
        .arg(&server.page)
        .args([&log, &broken, &volts])
        .args(&parts)
        .arg("chromium")
        .arg(folder.join("pictures"))
        .env("PYTHONPYCACHEPREFIX", folder.join("python-cache"));
    let said = run(&mut command).unwrap_or_else(|reason| panic!("{reason:#}"));
    assert!(said.contains("the files went well"), "{said}");
}
