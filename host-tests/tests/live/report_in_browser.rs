//! Reports in a browser, opened as files, at desktop and phone widths, in light and dark theme, and printed.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.
use std::path::Path;
use std::process::Command;

use host_tests::program;
use host_tests::python::{environment, run, scripts};
use tempfile::TempDir;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn a_report_shows_its_data_on_a_screen_and_on_paper() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = environment(&scripts().join("browser.txt"), folder).unwrap();
    let dir = TempDir::new().unwrap();
    let campaign = Path::new(env!("CARGO_MANIFEST_DIR")).join("../workbench/data/demonstration");
    let campaign = campaign.to_str().unwrap();
    for arguments in [
        &[
            "explain", campaign, "--model", "nominal", "--report", "e.html",
        ][..],
        &["loop", "--scenario", "quick", "--report", "l.html"],
        &[
            "model", "fit", campaign, "--model", "nominal", "--out", "f.toml", "--report", "f.html",
        ],
    ] {
        let output = program::run(dir.path(), arguments);
        assert!(output.status.success(), "{output:?}");
    }
    let mut command = Command::new(python);
    command
        .arg(scripts().join("report_in_browser.py"))
        .args(["e.html", "l.html", "f.html"].map(|name| dir.path().join(name)))
        .arg("chromium")
        .arg(folder.join("pictures"))
        .env("PYTHONPYCACHEPREFIX", folder.join("python-cache"));
    let said = run(&mut command).unwrap_or_else(|reason| panic!("{reason:#}"));
    assert!(said.contains("the reports went well"), "{said}");
}
