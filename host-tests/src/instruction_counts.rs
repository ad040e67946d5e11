//! `firmware/instructions.txt`: how many instructions the controller took on the emulated ECU when somebody last looked.
//!
//! A count that has moved away from its line is an error; with `HITCH_WRITE_INSTRUCTIONS=1` in the environment the lines
//! are written anew instead, and the change shows in review. Some have a bar besides, which no writing moves.

use std::{env, fs};

use anyhow::{Context, Result, ensure};

/// Writes the file instead of comparing with it.
const WRITE: &str = "HITCH_WRITE_INSTRUCTIONS";
const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../firmware/instructions.txt");
const HEADING: &str = "\
# Instructions on the emulated Cortex-M4. Written by `HITCH_WRITE_INSTRUCTIONS=1 cargo xtask test`.
";
/// Growth that isn't worth a line in a review, per mille: changes elsewhere move what the compiler merges.
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
    if env::var_os(WRITE).is_some() {
        return fs::write(PATH, format!("{HEADING}{}", lines.concat()))
            .with_context(|| format!("can't write {PATH}"));
    }
    let golden = fs::read_to_string(PATH).with_context(|| format!("can't read {PATH}"))?;
    counts.iter().try_for_each(|&(name, count)| {
        let line = golden.lines().find_map(|line| line.strip_prefix(name));
        let known: u64 = line
            .and_then(|rest| rest.trim().parse().ok())
            .with_context(|| format!("{PATH} knows no {name}: write it with {WRITE}=1"))?;
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
