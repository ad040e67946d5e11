//! `firmware/instructions.txt`: reference counts of the controller's instructions on the emulated ECU.
//!
//! A count that deviates from its reference is an error; with `HITCH_WRITE_INSTRUCTIONS=1` in the environment the
//! references are updated instead, and the change is visible in review. Some counts also have a fixed limit.

use std::{env, fs};

use anyhow::{Context, Result, ensure};

/// Writes the file instead of comparing with it.
const WRITE: &str = "HITCH_WRITE_INSTRUCTIONS";
const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware/instructions.txt");
const HEADING: &str = "\
# Instructions on the emulated Cortex-M4. Written by `HITCH_WRITE_INSTRUCTIONS=1 cargo xtask test`.
";
const IMAGES_PATH: &str = concat!(
    env!("CARGO_MANIFEST_DIR"),
    "/../firmware/instructions-images.txt"
);
const IMAGES_HEADING: &str = "\
# Instructions from the converters' codes to the pulses, at most, in the images as they are flashed, on the models of both
# parts. Written by `HITCH_WRITE_INSTRUCTIONS=1 cargo xtask test`.
";
/// Tolerated growth, per mille: changes elsewhere affect what the compiler merges.
const GROWTH_PER_MILLE: u64 = 60;
/// Another compiler may do with so much less.
const SHRINKAGE_PER_MILLE: u64 = 100;

/// What parts may take whatever is written down: plain code for an evenly spaced table without checks, for bilinear
/// interpolation, and for proportional and integral part with anti-windup.
const BARS: [(&str, u64); 3] = [
    ("lift-map-worst", 17),
    ("lower-map-of-flow-and-drop-worst", 41),
    ("pi-worst", 37),
];

/// Compares counts with their bars and with the lines of their names, or writes them down.
///
/// # Errors
/// If one is missing, above its bar or has moved.
pub fn check(counts: &[(&str, u64)]) -> Result<()> {
    let lines: Vec<String> = counts
        .iter()
        .map(|(name, count)| format!("{name} {count}\n"))
        .collect();
    print!("{}", lines.concat());
    for (name, bar) in BARS {
        let count = counts.iter().find(|count| count.0 == name);
        let &(_, count) = count.with_context(|| format!("{name} was not counted"))?;
        ensure!(
            count <= bar,
            "{name} takes {count} instructions, more than {bar}"
        );
    }
    compare(PATH, HEADING, counts)
}

/// Compares the counts of the images as they are flashed with their lines, or writes them down.
///
/// # Errors
/// If one is missing or has moved.
pub fn check_images(counts: &[(&str, u64)]) -> Result<()> {
    compare(IMAGES_PATH, IMAGES_HEADING, counts)
}

fn compare(path: &str, heading: &str, counts: &[(&str, u64)]) -> Result<()> {
    if env::var_os(WRITE).is_some() {
        let lines: String = counts
            .iter()
            .map(|(name, count)| format!("{name} {count}\n"))
            .collect();
        return fs::write(path, format!("{heading}{lines}"))
            .with_context(|| format!("can't write {path}"));
    }
    let golden = fs::read_to_string(path).with_context(|| format!("can't read {path}"))?;
    counts.iter().try_for_each(|&(name, count)| {
        let line = golden.lines().find_map(|line| line.strip_prefix(name));
        let known: u64 = line
            .and_then(|rest| rest.trim().parse().ok())
            .with_context(|| format!("{path} knows no {name}: write it with {WRITE}=1"))?;
        let (least, most) = (
            known - known * SHRINKAGE_PER_MILLE / 1000,
            known + known * GROWTH_PER_MILLE / 1000 + 1,
        );
        ensure!(
            (least..=most).contains(&count),
            "{name} takes {count} instructions and took {known}; if that is meant, write it with {WRITE}=1"
        );
        Ok(())
    })
}
