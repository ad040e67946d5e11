//! The page of `hitch serve` in a browser, at desktop and phone widths, in light and dark theme.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder. With
//! `UPDATE_PICTURE=1 cargo test -p host-tests --test live -- --ignored page_in_browser`, one of them becomes `docs/page.png`.
use std::fs;
use std::path::Path;
use std::process::Command;

use host_tests::page_server::PageServer;
use host_tests::program::hitch;
use host_tests::python::{environment, run};
use host_tests::refusal;
use tempfile::TempDir;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn the_whole_story_by_clicking() {
    let scripts = Path::new(env!("CARGO_MANIFEST_DIR")).join("python");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = environment(&scripts.join("browser.txt"), folder).unwrap();
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let wrong = refusal::folder();
    refusal::write(
        &wrong,
        "c/lift.csv",
        refusal::log().replacen("16.0", "oops", 1),
    );
    let broken = PageServer::start(wrong.path(), &["c"]);
    let pictures = folder.join("pictures");
    let mut command = Command::new(python);
    command
        .arg(scripts.join("page_in_browser.py"))
        .args([&server.page, &broken.page])
        .arg(hitch().get_program())
        .arg("chromium")
        .arg(&pictures)
        .env("PYTHONPYCACHEPREFIX", folder.join("python-cache"));
    let said = run(&mut command).unwrap_or_else(|reason| panic!("{reason:#}"));
    println!("{said}");
    assert!(said.contains("the whole story went well"), "{said}");
    if std::env::var_os("UPDATE_PICTURE").is_some() {
        let shown = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/page.png");
        fs::copy(pictures.join("signature.png"), shown).unwrap();
    }
}
