//! The proposed next experiment on the page of `hitch serve` in a browser: its pictures, and its currents as files.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.

use std::fs;
use std::path::PathBuf;

use host_tests::page_server::PageServer;
use tempfile::TempDir;

use crate::browser::operate;

/// The only run of the campaign: a loss of the return line and less flow of the lowering valve act alike in it.
const RUN: &str = "lower_2.2A_250kg.csv";

/// A campaign that cannot decide between two effects.
fn undecided() -> TempDir {
    let shipped = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("campaigns/known-return-line");
    let dir = TempDir::new().unwrap();
    let manifest = fs::read_to_string(shipped.join("campaign.toml")).unwrap();
    let (head, runs) = manifest.split_once("[[run]]").unwrap();
    let mut runs = runs.split("[[run]]");
    let run = runs.find(|run| run.contains(RUN)).unwrap();
    fs::create_dir(dir.path().join("few")).unwrap();
    let text = format!("{head}[[run]]{run}");
    fs::write(dir.path().join("few/campaign.toml"), text).unwrap();
    fs::copy(shipped.join(RUN), dir.path().join("few").join(RUN)).unwrap();
    dir
}

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn the_next_experiment_is_seen_and_saved() {
    let dir = undecided();
    let server = PageServer::start(dir.path(), &["few"]);
    let said = operate("next_in_browser.py", &server.page, &[]);
    println!("{said}");
    assert!(said.contains("the next experiment went well"), "{said}");
}
