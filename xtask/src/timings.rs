//! Where the time of a task goes, as a Markdown table.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::time::Instant;

use anyhow::{Context, Result};
use arm_build::workspace;

/// The times of a task; without the option `--timings` they are not printed.
#[derive(Debug)]
pub struct Timings {
    asked: bool,
    rows: Vec<(String, f64)>,
}

/// Something that cargo has compiled or run.
#[derive(Debug, PartialEq)]
pub struct Unit {
    /// Name of its package.
    pub package: String,
    /// Empty for a library, otherwise its name and kind.
    target: String,
    /// Time of one core, s.
    pub seconds: f64,
}

impl Timings {
    /// No times yet.
    pub fn new(asked: bool) -> Self {
        Self {
            asked,
            rows: Vec::new(),
        }
    }

    /// Whether the table is wanted.
    pub fn asked(&self) -> bool {
        self.asked
    }

    /// Measures a part of the task.
    ///
    /// # Errors
    /// Those of the part.
    pub fn measured<T>(&mut self, name: &str, part: impl FnOnce() -> Result<T>) -> Result<T> {
        let started = Instant::now();
        let result = part();
        self.add(name, started.elapsed().as_secs_f64());
        result
    }

    /// Adds a row.
    pub fn add(&mut self, name: &str, seconds: f64) {
        self.rows.push((name.to_owned(), seconds));
    }

    /// Adds the parts of a build: sums over dependencies and crates, and each test program.
    pub fn add_units(&mut self, units: &[Unit]) {
        let packages = fs::read_to_string(workspace::root().join("Cargo.lock"));
        let packages = packages.unwrap_or_default();
        // A package of the registry has a source in the lock file; a crate of the workspace has none.
        let is_own = |unit: &Unit| {
            let entry = format!("name = \"{}\"\nversion = ", unit.package);
            let entry = packages.split("\n\n").find(|text| text.contains(&entry));
            entry.is_some_and(|text| !text.contains("source = "))
        };
        let (own, foreign): (Vec<&Unit>, Vec<&Unit>) = units.iter().partition(|unit| is_own(unit));
        let sum = |units: &[&Unit]| units.iter().map(|unit| unit.seconds).sum();
        self.add(
            &format!(
                "&nbsp; dependencies, {} compilations, one core",
                foreign.len()
            ),
            sum(&foreign),
        );
        self.add("&nbsp; workspace, one core", sum(&own));
        let mut by_name: BTreeMap<String, f64> = BTreeMap::new();
        for unit in own {
            let name = format!("{} {}", unit.package, unit.target);
            *by_name.entry(name.trim().to_owned()).or_default() += unit.seconds;
        }
        self.add_longest("&nbsp; &nbsp; ", by_name.into_iter().collect(), 3.0);
    }

    /// Adds rows in the order of their times; those below a limit in s as one.
    pub fn add_longest(&mut self, indent: &str, mut rows: Vec<(String, f64)>, limit_s: f64) {
        rows.sort_by(|a, b| b.1.total_cmp(&a.1));
        let (long, short): (Vec<_>, Vec<_>) = rows.into_iter().partition(|row| row.1 >= limit_s);
        for (name, seconds) in long {
            self.add(&format!("{indent}{name}"), seconds);
        }
        let rest = short.iter().map(|row| row.1).sum();
        self.add(
            &format!("{indent}{} others below {limit_s:.0} s", short.len()),
            rest,
        );
    }

    /// Prints the table if it is wanted.
    pub fn print(&self) {
        if self.asked {
            println!("\n| part | s |\n|---|---|");
            for (name, seconds) in &self.rows {
                println!("| {name} | {seconds:.0} |");
            }
            println!();
        }
    }
}

/// The units of the latest build with `--timings` into a folder.
///
/// # Errors
/// If cargo's report is not there.
pub fn units(folder: &Path) -> Result<Vec<Unit>> {
    let path = folder.join("cargo-timings/cargo-timing.html");
    let text = fs::read_to_string(&path).with_context(|| path.display().to_string())?;
    units_in(&text).with_context(|| format!("{} has no list of units", path.display()))
}

/// The units in the text of cargo's report.
fn units_in(text: &str) -> Option<Vec<Unit>> {
    let (_, list) = text.split_once("const UNIT_DATA = [")?;
    let (list, _) = list.split_once("];")?;
    let value = |entry: &str, key: &str| {
        let (_, rest) = entry.split_once(&format!("\"{key}\": "))?;
        let line = rest.lines().next()?.trim_end_matches(',');
        Some(line.trim_matches('"').replace("\\\"", "\""))
    };
    let entries = list.split("\"i\": ").skip(1);
    let unit = |entry: &str| {
        Some(Unit {
            package: value(entry, "name")?,
            target: value(entry, "target")?.trim().to_owned(),
            seconds: value(entry, "duration")?.parse().ok()?,
        })
    };
    entries.map(unit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_come_from_the_report_of_cargo() {
        let text = "x\nconst UNIT_DATA = [\n  {\n    \"i\": 149,\n    \"name\": \"hitch-campaign\",\n    \"version\": \"0.1.0\",\n    \
                    \"target\": \" columns \\\"test\\\" (test)\",\n    \"features\": [],\n    \"start\": 0.0,\n    \"duration\": \
                    7.5,\n    \"sections\": null\n  }\n];\n";
        let unit = Unit {
            package: "hitch-campaign".to_owned(),
            target: "columns \"test\" (test)".to_owned(),
            seconds: 7.5,
        };
        assert_eq!(units_in(text), Some(vec![unit]));
        assert_eq!(units_in("nothing"), None);
    }

    #[test]
    fn short_rows_are_one() {
        let mut timings = Timings::new(true);
        let rows = [("a", 1.0), ("b", 5.0), ("c", 1.5)];
        let rows = rows.map(|(name, seconds)| (name.to_owned(), seconds));
        timings.add_longest("", rows.to_vec(), 2.0);
        let expected = [("b", 5.0), ("2 others below 2 s", 2.5)];
        let expected = expected.map(|(name, seconds)| (name.to_owned(), seconds));
        assert_eq!(timings.rows, expected);
    }
}
