//! The benchmark of a part, and what it measures.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use anyhow::{Context, Result, bail};
use arm_build::{process, programs, workspace};

/// Environment variable that names the heuristic to remove.
pub const SWITCH: &str = "HITCH_ABLATION";

/// A part of the project with its own benchmark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Battery {
    /// Drawn campaigns with a hidden effect: `hidden_effects`.
    Identification,
    /// Moves of drawn hitches: `drive-drawn-hitches`.
    Control,
}

/// Drawn campaigns: first seed, number, and the other arguments.
const CAMPAIGNS: [&str; 4] = [
    "--seed 1 --count 18 --family steady --plan lab",
    "--seed 1 --count 5 --family dynamic --plan lab",
    "--seed 3101 --count 8 --family steady --plan field",
    "--seed 8001 --count 3 --family steady --plan lab --kind nothing",
];

/// Drawn hitches: the first moves after power-up, many moves of few machines, and spools of second order.
const HITCHES: [&str; 3] = [
    "--seed 1 --machines 120 --moves 6 --worst 0",
    "--seed 501 --machines 30 --moves 20 --worst 0",
    "--seed 1001 --machines 60 --moves 6 --worst 0 --spool 50,0.6,5",
];

/// Rows of the benchmark of the identification: start of the row there, and the heading here.
const RATES: [(&str, &str); 6] = [
    ("one hidden: named first", "first"),
    ("named first: alone", "alone, 1.1 sigma"),
    ("two hidden: exactly both", "both"),
    ("nothing hidden: something named", "named, none hidden"),
    ("outside the catalogue: said so", "outside said"),
    ("95 % intervals that hold the truth", "intervals"),
];

/// Rows of the benchmark of motion: start of the row there, and the heading here.
const FIGURES: [(&str, &str); 6] = [
    ("time over shortest", "time ratio"),
    ("overshoot, deg", "overshoot, deg"),
    ("final error, deg", "final error, deg"),
    ("pressure swing ratio", "pressure swing"),
    ("switched on after arrival", "on after arrival"),
    ("fault", "fault"),
];

/// Result of a benchmark.
#[derive(Debug, Default)]
pub struct Outcome {
    /// Cells of the table, without the cells that compare.
    cells: Vec<String>,
    /// Whether the answer was good, by campaign.
    good: BTreeMap<String, bool>,
    /// Processor time, s.
    cpu_s: f64,
}

impl std::str::FromStr for Battery {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        match text {
            "identification" => Ok(Self::Identification),
            "control" => Ok(Self::Control),
            unknown => bail!("there is no part {unknown}: identification or control?"),
        }
    }
}

impl Battery {
    /// Builds the benchmark in a copy of the workspace.
    pub fn build(self, source: &Path) -> Result<PathBuf> {
        let target = workspace::target().join("ablation/target");
        let (what, name): (&[&str], &str) = match self {
            Self::Identification => (&["bench", "--no-run", "--bench"], "hidden_effects"),
            Self::Control => (&["build", "--release", "--example"], "drive-drawn-hitches"),
        };
        let mut command = process::command(workspace::cargo(), what);
        command
            .arg(name)
            .args(["--package", "host-tests"])
            .current_dir(source)
            .env("CARGO_TARGET_DIR", target)
            // Link time optimisation takes minutes and changes no rate.
            .env("CARGO_PROFILE_RELEASE_LTO", "off")
            .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "16")
            .env("CARGO_PROFILE_BENCH_LTO", "off")
            .env("CARGO_PROFILE_BENCH_CODEGEN_UNITS", "16");
        // The last program of that name.
        let name = name.replace('-', "_");
        let mut built = programs::build(&mut command)?.into_iter();
        let found = built.rfind(|program| program.name == name);
        Ok(found.context("cargo names no benchmark")?.path)
    }

    /// Runs the benchmark without one heuristic, or with all.
    pub fn run(self, program: &Path, without: Option<&str>) -> Result<Outcome> {
        let runs: &[&str] = match self {
            Self::Identification => &CAMPAIGNS,
            Self::Control => &HITCHES,
        };
        let before_s = children_s()?;
        let mut outcome = Outcome::default();
        let (mut tables, mut lines) = (Vec::new(), String::new());
        for arguments in runs {
            let mut command = Command::new(program);
            command
                .args(arguments.split(' '))
                .current_dir(workspace::root().join("host-tests"));
            if self == Self::Identification {
                command.args(["--bench"]);
            }
            match without {
                Some(name) => command.env(SWITCH, name),
                None => command.env_remove(SWITCH),
            };
            let output = command.output().with_context(|| process::shown(&command))?;
            if !output.status.success() {
                bail!(
                    "{} failed: {}\n{}",
                    process::shown(&command),
                    output.status,
                    String::from_utf8_lossy(&output.stderr)
                );
            }
            tables.push(String::from_utf8(output.stdout)?);
            lines.push_str(&String::from_utf8_lossy(&output.stderr));
        }
        outcome.cpu_s = children_s()? - before_s;
        match self {
            Self::Identification => {
                outcome.cells = RATES.iter().map(|(row, _)| rate(&tables, row)).collect();
                outcome.good = lines.lines().filter_map(graded).collect();
            }
            Self::Control => {
                outcome.cells = FIGURES
                    .iter()
                    .map(|(row, _)| figures(&tables, row))
                    .collect();
            }
        }
        Ok(outcome)
    }

    /// Head of the Markdown table.
    pub fn header(self) -> String {
        let headings: Vec<&str> = match self {
            Self::Identification => {
                let rates = RATES.iter().map(|(_, heading)| *heading);
                rates.chain(["lost, won", "CPU time"]).collect()
            }
            Self::Control => FIGURES.iter().map(|(_, heading)| *heading).collect(),
        };
        let rule = "|---".repeat(headings.len() + 1);
        format!("| without | {} |\n{rule}|", headings.join(" | "))
    }

    /// A row of the Markdown table.
    pub fn row(self, name: &str, whole: &Outcome, without: &Outcome) -> String {
        let mut cells = vec![name.to_owned()];
        cells.extend(without.cells.iter().cloned());
        if self == Self::Identification {
            let differs = |from: bool| {
                let cases = whole.good.iter().filter(|(_, good)| **good == from);
                cases
                    .filter(|(case, _)| without.good.get(*case) == Some(&!from))
                    .count()
            };
            cells.push(format!("{}, {}", differs(true), differs(false)));
            cells.push(format!("{:.2}", without.cpu_s / whole.cpu_s));
        }
        format!("| {} |", cells.join(" | "))
    }
}

/// Sum of the rates `a/b` in the rows of some tables that start like this.
fn rate(tables: &[String], row: &str) -> String {
    let lines = tables.iter().flat_map(|table| table.lines());
    let rows = lines.filter_map(|line| line.strip_prefix("| ")?.strip_prefix(row));
    let rates = rows.filter_map(|rest| {
        let (_, cell) = rest.split_once("| ")?;
        let (a, b) = cell.split([' ', '|']).next()?.split_once('/')?;
        Some((a.parse::<u32>().ok()?, b.parse::<u32>().ok()?))
    });
    let (a, b) = rates.fold((0, 0), |sum, rate| (sum.0 + rate.0, sum.1 + rate.1));
    format!("{a}/{b}")
}

/// Median, 95 % and share beyond the bar in the first row of each table that starts like this.
fn figures(tables: &[String], row: &str) -> String {
    let of_table = |table: &String| {
        let line = table.lines().find(|line| line.starts_with(row))?;
        let words: Vec<&str> = line[row.len()..].split_whitespace().collect();
        let [median, high, _, beyond @ ..] = words.as_slice() else {
            return None;
        };
        Some(match beyond {
            [share, ..] => format!("{high}, {share} %"),
            [] => format!("{median}, {high}"),
        })
    };
    let cells: Vec<String> = tables.iter().filter_map(of_table).collect();
    cells.join("; ")
}

/// A campaign and whether its answer was good, from a progress line of the benchmark.
fn graded(line: &str) -> Option<(String, bool)> {
    let (case, rest) = line.split_once(": ")?;
    let good = match rest.split_once(',')?.0 {
        "good" => true,
        "miss" => false,
        _ => return None,
    };
    Some((case.to_owned(), good))
}

/// Processor time of all children that have ended, s.
fn children_s() -> Result<f64> {
    let text = fs::read_to_string("/proc/self/stat")?;
    let fields = text.rsplit_once(')').context("/proc/self/stat")?.1;
    let fields: Vec<&str> = fields.split_whitespace().collect();
    // User and system time of waited-for children, proc(5): fields 16 and 17, in hundredths of a second.
    let ticks: f64 = fields[13].parse::<f64>()? + fields[14].parse::<f64>()?;
    Ok(ticks / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_add_up_over_tables() {
        let table =
            |cell: &str| format!("| a | hitch explain |\n| one hidden: named first | {cell} |\n");
        let tables = [
            table("26/29 (74-96 %)"),
            table("3/4 (20-99 %)"),
            table("cannot"),
        ];
        assert_eq!(rate(&tables, "one hidden: named first"), "29/33");
    }

    #[test]
    fn a_progress_line_says_whether_the_answer_was_good() {
        let line = "Steady Lab 3 hitch explain: good, [\"a\"] in 1.0 s";
        assert_eq!(
            graded(line),
            Some(("Steady Lab 3 hitch explain".to_owned(), true))
        );
        assert_eq!(graded("some other line"), None);
    }

    #[test]
    fn figures_are_read_from_the_first_table() {
        let text = "all: 6 moves\n  median 95 % largest\novershoot, deg   0.00  0.25  0.40   1.5 %\n\
                    time over shortest   1.10  1.40  2.00\n";
        assert_eq!(figures(&[text.to_owned()], "overshoot, deg"), "0.25, 1.5 %");
        assert_eq!(
            figures(&[text.to_owned()], "time over shortest"),
            "1.10, 1.40"
        );
    }
}
