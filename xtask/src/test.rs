//! Every test: those of the host, and those that need the emulated target or a browser.

use std::fmt;
use std::io::{BufRead, BufReader, Write, stdout};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};
use arm_build::images;
use arm_build::toolchain::Way;
use arm_build::{process, setup, workspace};

use crate::image;

/// Environment variable with the image for the tests that run it.
const IMAGE_VARIABLE: &str = "HITCH_EMULATED_IMAGE";

/// Environment variable with its maximum stack depth, in bytes.
const STACK_VARIABLE: &str = "HITCH_STACK_BOUND";

/// Environment variable with the folder of the images for the parts.
const IMAGES_VARIABLE: &str = "HITCH_BOARD_IMAGES";

/// Names the program `hitch` for the tests that run it.
const PROGRAM_VARIABLE: &str = "HITCH_PROGRAM";

/// Modules of the test program `live` with tests that need images or a browser. Each runs alone: some are in real time.
const ON_TARGET: [&str; 12] = [
    "board_bench::",
    "bus_in_browser::",
    "ecu_page::",
    "ecu_process::",
    "emulated::",
    "emulated_ecu::",
    "files_in_browser::",
    "overlay_in_browser::",
    "page_in_browser::",
    "python_clients::",
    "report_in_browser::",
    "second_in_browser::",
];

/// Numbers of tests by result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Counts {
    passed: u32,
    failed: u32,
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} passed, {} failed", self.passed, self.failed)
    }
}

/// Result of a group of tests.
struct Outcome {
    counts: Counts,
    /// Exit status of cargo, which also covers tests that do not compile or crash.
    success: bool,
}

/// Builds the images, runs all tests, and finally prints a line with their numbers.
pub fn run(way: Option<Way>) -> Result<()> {
    let way = setup::toolchain(way)?;
    setup::emulator()?;
    setup::browser()?;
    let image = image::build_all(way)?;

    let host = run_group(&mut cargo_test(&["--workspace"]))?;
    let mut target = Outcome {
        counts: Counts::default(),
        success: true,
    };
    for module in ON_TARGET {
        // With the features of the whole workspace, so that nothing is rebuilt.
        let mut on_target = cargo_test(&["--workspace", "--test", "live"]);
        on_target
            .args(["--", "--ignored", "--nocapture", module])
            .env(IMAGE_VARIABLE, &image.path)
            .env(IMAGES_VARIABLE, images::folder(way))
            .env(STACK_VARIABLE, image.stack.bytes().to_string());
        let outcome = run_group(&mut on_target)?;
        target.counts.passed += outcome.counts.passed;
        target.counts.failed += outcome.counts.failed;
        target.success &= outcome.success && outcome.counts.passed > 0;
    }

    summarise(&host, &target)
}

fn summarise(host: &Outcome, target: &Outcome) -> Result<()> {
    let total = Counts {
        passed: host.counts.passed + target.counts.passed,
        failed: host.counts.failed + target.counts.failed,
    };
    println!(
        "\nhost tests: {}\nemulated target tests: {}",
        host.counts, target.counts
    );
    println!("{total}");
    for (name, outcome) in [("host", host), ("emulated target", target)] {
        if outcome.counts.passed == 0 {
            bail!("no {name} test passed: they must not be left out");
        }
        if !outcome.success || outcome.counts.failed > 0 {
            bail!("the {name} tests failed; see above");
        }
    }
    Ok(())
}

fn cargo_test(arguments: &[&str]) -> Command {
    let mut command = process::command(workspace::cargo(), &["test", "--locked", "--no-fail-fast"]);
    // The build of the tests contains the program, because the workbench has a test that runs it.
    let program = workspace::target().join("debug/hitch");
    command.args(arguments).env(PROGRAM_VARIABLE, program);
    command
}

/// Runs a test command, forwards its output, and counts its results.
fn run_group(command: &mut Command) -> Result<Outcome> {
    process::announce(command);
    stdout().flush()?;
    let started = command.stdout(Stdio::piped()).spawn();
    let mut child = started.with_context(|| format!("can't start {}", process::shown(command)))?;
    let mut counts = Counts::default();
    for line in BufReader::new(child.stdout.take().context("the tests have no output")?).lines() {
        let line = line.context("can't read what the tests print")?;
        println!("{line}");
        if let Some(more) = counts_in(&line) {
            counts.passed += more.passed;
            counts.failed += more.failed;
        }
    }
    Ok(Outcome {
        counts,
        success: child.wait()?.success(),
    })
}

/// The counts in a line like `test result: ok. 3 passed; 0 failed; 1 ignored; ...`.
fn counts_in(line: &str) -> Option<Counts> {
    let (_, results) = line.strip_prefix("test result: ")?.split_once(". ")?;
    let count = |what: &str| {
        results
            .split("; ")
            .find_map(|part| part.strip_suffix(what)?.trim().parse().ok())
    };
    Some(Counts {
        passed: count(" passed")?,
        failed: count(" failed")?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_come_from_the_closing_line_of_each_test_program() {
        let line = "test result: FAILED. 12 passed; 3 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.5s";
        assert_eq!(
            counts_in(line),
            Some(Counts {
                passed: 12,
                failed: 3
            })
        );
        assert_eq!(counts_in("test kinematics ... ok"), None);
    }

    #[test]
    fn a_group_without_a_passed_test_fails_the_whole() {
        let outcome = |passed, failed, success| Outcome {
            counts: Counts { passed, failed },
            success,
        };
        assert!(summarise(&outcome(3, 0, true), &outcome(1, 0, true)).is_ok());
        assert!(summarise(&outcome(3, 0, true), &outcome(0, 0, true)).is_err());
        assert!(summarise(&outcome(3, 1, false), &outcome(1, 0, true)).is_err());
        assert!(summarise(&outcome(3, 0, false), &outcome(1, 0, true)).is_err());
    }
}
