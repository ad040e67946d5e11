//! Form of a rejection: one clear line, exit code 2, no output file, no standard output.
use std::fs;
use std::path::Path;
use std::process::Output;

use tempfile::TempDir;

use crate::program::run;

/// Manifest of the campaign `c`.
pub const MANIFEST: &str = r#"format = 1
name = "small"
sample_rate_hz = 50

[[run]]
file = "lift.csv"
bench = "hitch"
load_kg = 150
"#;

/// A log of a hitch at rest.
#[must_use]
pub fn log() -> String {
    let row = |i: usize| format!("{:.2},0.0,0.0,4.0,16.0,0.0,90.0\n", i as f64 * 0.02);
    let header = "time_s,lift_current_a,lower_current_a,pump_pressure_bar,cylinder_pressure_bar,flow_lpm,rocker_angle_deg";
    format!("{header}\n{}", (0..100).map(row).collect::<String>())
}

/// A folder with the campaign `c`, the log `log.csv`, and whatever a case adds.
///
/// # Panics
/// If it cannot be made.
#[must_use]
pub fn folder() -> TempDir {
    let dir = TempDir::new().unwrap();
    fs::create_dir(dir.path().join("c")).unwrap();
    fs::create_dir(dir.path().join("empty")).unwrap();
    write(&dir, "c/campaign.toml", MANIFEST);
    write(&dir, "c/lift.csv", log());
    write(&dir, "log.csv", log());
    dir
}

/// Writes a file of it.
///
/// # Panics
/// If it cannot be written.
pub fn write(dir: &TempDir, name: &str, text: impl AsRef<[u8]>) {
    fs::write(dir.path().join(name), text).unwrap();
}

/// Asserts that the program refused, said so in one line that holds `expected`, and left nothing behind.
///
/// # Panics
/// If it did not.
pub fn refused(dir: &Path, arguments: &[&str], expected: &str) {
    let before = names(dir);
    let Output {
        status,
        stdout,
        stderr,
    } = run(dir, arguments);
    let said = String::from_utf8(stderr).unwrap();
    let case = format!("hitch {}: {said}", arguments.join(" "));
    assert_eq!(status.code(), Some(2), "{case}");
    assert_eq!(said.lines().count(), 1, "{case}");
    assert!(said.contains(expected), "expected {expected} of {case}");
    assert!(stdout.is_empty(), "{case}");
    assert_eq!(names(dir), before, "{case}");
}

fn names(dir: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(dir)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}
