//! Several runs over one another in the page of `hitch serve` in a browser.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.
use std::path::Path;
use std::process::Command;

use host_tests::page_server::PageServer;
use host_tests::python::{environment, run, scripts};
use host_tests::refusal;
use tempfile::TempDir;

/// Runs and samples of the campaign of which the drawing time is measured.
const RUNS: usize = 20;
const SAMPLES: usize = 1500;

/// A campaign of long runs with four channels: the load swings on the oil, each time a little faster.
fn long_campaign(dir: &TempDir) {
    let mut manifest = "format = 1\nname = \"long\"\nsample_rate_hz = 50\n".to_owned();
    let log = refusal::log();
    let header = log.lines().next().unwrap();
    for index in 0..RUNS {
        let file = format!("run-{index}.csv");
        manifest += &format!("\n[[run]]\nfile = \"{file}\"\nbench = \"hitch\"\nload_kg = 150\n");
        let rate = 0.2 + 0.02 * index as f64;
        let row = |sample: usize| {
            let time_s = sample as f64 * 0.02;
            let swing = (rate * time_s).sin();
            let noise = f64::from((sample as u32).wrapping_mul(2_654_435_761) >> 16) / 65536.0;
            format!(
                "{time_s:.2},0.0,0.0,{:.3},{:.3},{:.3},{:.3}\n",
                4.0 + 0.2 * noise,
                16.0 + swing + 0.3 * noise,
                0.1 * noise,
                90.0 + 0.1 * swing + 0.02 * noise
            )
        };
        let rows: String = (0..SAMPLES).map(row).collect();
        refusal::write(dir, &format!("c/{file}"), format!("{header}\n{rows}"));
    }
    refusal::write(dir, "c/campaign.toml", manifest);
}

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn several_runs_are_overlaid() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = environment(&scripts().join("browser.txt"), folder).unwrap();
    let dir = refusal::folder();
    long_campaign(&dir);
    let shipped = PageServer::start(dir.path(), &[]);
    let long = PageServer::start(dir.path(), &["c"]);
    let mut command = Command::new(python);
    command
        .arg(scripts().join("overlay_in_browser.py"))
        .args([&shipped.page, &long.page])
        .arg("chromium")
        .arg(folder.join("pictures"))
        .env("PYTHONPYCACHEPREFIX", folder.join("python-cache"));
    let said = run(&mut command).unwrap_or_else(|reason| panic!("{reason:#}"));
    println!("{said}");
    assert!(said.contains("the overlay went well"), "{said}");
}
