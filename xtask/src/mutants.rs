//! Mutation tests of the critical parts: their tests have to detect every mutation of their code.
//!
//! This takes minutes. `firmware/mutants.txt` therefore records the tested state of each part; after a change of the
//! part or of its tests, the mutation test is repeated.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use arm_build::{process, workspace};
use crc::{CRC_64_XZ, Crc};
use hitch_quantities::calibration::design_parameters::{
    PositionParameters, SafetyParameters, SensorParameters,
};

/// A part of the firmware, and the tests that have to detect every mutation of it.
#[derive(Debug)]
struct Part {
    name: &'static str,
    /// The mutated files, or folders of them, relative to the workspace's root.
    changed: &'static [&'static str],
    /// Other files that affect the result, including its tests.
    decides: &'static [&'static str],
    /// The mutated packages; the first one has the tests.
    packages: &'static [&'static str],
    /// Its tests, as options of cargo.
    tests: &'static [&'static str],
    /// Excluded tests: random ones with long run times.
    skipped: Option<&'static str>,
    /// Function whose mutation results in an endless loop, which the tests detect by their time limit, and the ECU by
    /// its watchdog.
    looping: Option<&'static str>,
}

/// The parts whose tests also depend on values in the calibration.
const POSITION: &str = "position";
const SAFETY: &str = "safety";

/// The quicker ones first.
const PARTS: [Part; 4] = [
    Part {
        name: "storage",
        changed: &["firmware/protocols/src/storage/store.rs"],
        decides: &[
            "firmware/protocols/src/storage",
            "firmware/quantities/src/calibration/block.rs",
            "firmware/quantities/src/calibration/calibration_words.rs",
            "firmware/quantities/src/crc32.rs",
            "firmware/protocols/tests/storage",
        ],
        packages: &["hitch-protocols"],
        tests: &["--test=storage"],
        skipped: None,
        looping: Some("Reader<'_, F>::entries"),
    },
    Part {
        name: "remote",
        changed: &[
            "firmware/protocols/src/j1939/address_book.rs",
            "firmware/protocols/src/j1939/name.rs",
            "firmware/protocols/src/j1939/remote.rs",
        ],
        decides: &[
            "firmware/protocols/src/j1939/hitch.rs",
            "firmware/protocols/src/j1939/node.rs",
            "firmware/protocols/src/j1939/time.rs",
            "firmware/protocols/tests/j1939",
        ],
        packages: &["hitch-protocols"],
        tests: &["--test=j1939"],
        skipped: None,
        looping: None,
    },
    Part {
        name: POSITION,
        changed: &["firmware/control/src/motion/position.rs"],
        decides: &[
            "firmware/control/src/valve/closing.rs",
            "firmware/control/src/valve/drop_scale.rs",
            "firmware/quantities/src/fixed.rs",
            "firmware/control/src/estimation/motion_observer.rs",
            "firmware/control/src/motion/bands.rs",
            "firmware/quantities/src/units.rs",
            "firmware/control/src/valve/phase.rs",
            "firmware/quantities/src/piston.rs",
            "firmware/control/tests/position.rs",
        ],
        packages: &["hitch-control"],
        tests: &["--lib", "--test=position"],
        skipped: None,
        looping: None,
    },
    Part {
        name: SAFETY,
        changed: &[
            "firmware/safety/src",
            "firmware/quantities/src/signals/trip.rs",
        ],
        decides: &[
            "firmware/quantities/src/calibration/linkage.rs",
            "firmware/quantities/src/calibration/valve_table.rs",
            "firmware/quantities/src/piston.rs",
            "firmware/quantities/src/signals/fault.rs",
            "firmware/quantities/src/signals/coils.rs",
            "firmware/quantities/src/signals/mod.rs",
            "firmware/quantities/src/units.rs",
            "firmware/safety/tests/envelope",
        ],
        packages: &["hitch-safety", "hitch-quantities"],
        tests: &["--test=envelope"],
        skipped: Some("any_inputs::"),
        looping: Some("Debounce::judge"),
    },
];

/// Records for which code of each part every mutation was detected.
const PROVEN: &str = "firmware/mutants.txt";
/// The version that is installed if there is none; versions differ slightly in their mutations.
const VERSION: &str = "27.1.0";
/// Number of parallel mutations.
const JOBS: &str = "2";
/// Exit code of cargo-mutants if a mutation was missed.
const SURVIVES: i32 = 2;
/// Exit code of cargo-mutants if no mutation was missed, but some tests exceeded the time limit.
const HANGS: i32 = 3;
/// Minimum time limit of the tests, s: they take a few seconds, more on a busy machine.
const TEST_TIME: &str = "20";

/// Applies all mutations to each part, and records the result; unless `again`, only if the part differs from the
/// record.
pub fn run(again: bool) -> Result<()> {
    let path = workspace::root().join(PROVEN);
    for part in &PARTS {
        if part.is_recorded()? && !again {
            continue;
        }
        let line = format!("{} {}", part.code()?, part.prove()?);
        let known = fs::read_to_string(&path).unwrap_or_default();
        fs::write(&path, with_line(&known, part.name, &line))
            .with_context(|| format!("can't write {PROVEN}"))?;
    }
    Ok(())
}

/// Names the parts that differ from the record. Their mutations take longer than all tests, so that only the nightly run
/// repeats them.
pub fn report() -> Result<()> {
    for part in &PARTS {
        part.is_recorded()?;
    }
    Ok(())
}

/// The record with a replaced line for a part.
fn with_line(known: &str, name: &str, line: &str) -> String {
    let title = "# Changes to the code of each part, and how its tests notice them. Written by `cargo xtask mutants`.";
    let lines = PARTS.iter().filter_map(|part| {
        let prefix = format!("{} ", part.name);
        if part.name == name {
            Some(line)
        } else {
            known.lines().find(|line| line.starts_with(&prefix))
        }
    });
    std::iter::once(title)
        .chain(lines)
        .map(|line| format!("{line}\n"))
        .collect()
}

impl Part {
    /// Whether the record is of the present code; says so.
    fn is_recorded(&self) -> Result<bool> {
        let code = self.code()?;
        let known = fs::read_to_string(workspace::root().join(PROVEN)).unwrap_or_default();
        let is_recorded = known.lines().any(|line| line.starts_with(&code));
        if is_recorded {
            println!("{PROVEN}: the tests notice every change to {code}")
        } else {
            println!("{PROVEN} does not know {code}; `cargo xtask mutants` tests it")
        }
        Ok(is_recorded)
    }

    /// Name and hash of all files that affect the result.
    fn code(&self) -> Result<String> {
        let crc = Crc::<u64>::new(&CRC_64_XZ);
        let mut digest = crc.digest();
        digest.update(format!("{self:?}").as_bytes());
        let values = match self.name {
            POSITION => format!("{:?}", PositionParameters::NOMINAL),
            SAFETY => {
                let limits = (SafetyParameters::NOMINAL, SensorParameters::NOMINAL);
                format!("{limits:?}")
            }
            _ => String::new(),
        };
        digest.update(values.as_bytes());
        for file in files(&[self.changed, self.decides].concat())? {
            digest.update(file.as_os_str().as_encoded_bytes());
            let path = workspace::root().join(file);
            digest.update(&fs::read(&path).with_context(|| path.display().to_string())?);
        }
        Ok(format!("{} code {:016x}", self.name, digest.finalize()))
    }

    /// Applies all mutations; returns their number.
    fn prove(&self) -> Result<String> {
        let folder = workspace::target().join("mutants").join(self.name);
        fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        self.mutate(&folder)?;
        let found = |list: &str| {
            let path = folder.join("mutants.out").join(list);
            fs::read_to_string(&path).with_context(|| path.display().to_string())
        };
        // The exit code of cargo-mutants does not distinguish these from tests over the time limit.
        let missed = found("missed.txt")?;
        ensure!(
            missed.is_empty(),
            "no test notices these changes:\n{missed}"
        );
        let hang = found("timeout.txt")?;
        let is_loop = |change: &str| self.looping.is_some_and(|name| change.ends_with(name));
        if let Some(slow) = hang.lines().find(|change| !is_loop(change)) {
            bail!(
                "the tests took too long to say whether they notice this; try again when there is less to do: {slow}"
            );
        }
        Ok(format!(
            "fail {} hang {} don't compile {}",
            found("caught.txt")?.lines().count(),
            hang.lines().count(),
            found("unviable.txt")?.lines().count()
        ))
    }

    /// Runs cargo-mutants.
    fn mutate(&self, folder: &Path) -> Result<()> {
        let mut command = process::command(program()?, &["mutants", "--no-config"]);
        command
            .args(["--jobs", JOBS, "--minimum-test-timeout", TEST_TIME])
            .args(self.packages.iter().flat_map(|name| ["--package", name]))
            .args(["--test-package", self.packages[0]])
            .args(self.tests.iter().map(|test| format!("--cargo-arg={test}")))
            .arg("--output")
            .arg(folder)
            .args(
                files(self.changed)?
                    .iter()
                    .map(|file| format!("--file={}", file.display())),
            )
            // Each job builds a mutated copy of the sources in its own folder: in a shared one, cargo would use the
            // output of another copy.
            .env_remove("CARGO_TARGET_DIR");
        if let Some(skipped) = self.skipped {
            let skip = format!("--cargo-test-arg={skipped}");
            command.args(["--cargo-test-arg=--", "--cargo-test-arg=--skip", &skip]);
        }
        process::announce(&command);
        let status = command.status().context("can't start cargo-mutants")?;
        ensure!(
            status.success() || [Some(SURVIVES), Some(HANGS)].contains(&status.code()),
            "cargo-mutants: {status}; either a change goes unnoticed, see above, or the tests could not be run"
        );
        Ok(())
    }
}

/// These files, and those in these folders, in order, relative to the workspace's root.
fn files(paths: &[&str]) -> Result<BTreeSet<PathBuf>> {
    let root = workspace::root();
    let mut files = BTreeSet::new();
    for path in paths {
        let found = workspace::files(&root.join(path))?.into_iter();
        files.extend(found.map(|file| file.strip_prefix(&root).unwrap_or(&file).to_owned()));
    }
    Ok(files)
}

/// Finds cargo-mutants, or installs it in the target folder.
fn program() -> Result<OsString> {
    const NAME: &str = "cargo-mutants";
    let folder = workspace::target().join("tools");
    let own = folder.join("bin").join(NAME).into_os_string();
    let is_there = |program: &OsString| {
        let ask = &mut process::command(program, &["mutants", "--version"]);
        process::output(ask).is_some()
    };
    for program in [OsString::from(NAME), own.clone()] {
        if is_there(&program) {
            return Ok(program);
        }
    }
    // Its run time is spent in child processes, so it is not optimised.
    let options = ["install", "--locked", "--debug", "--version", VERSION];
    let mut install = process::command(workspace::cargo(), &options);
    install.arg("--root").arg(folder).arg(NAME);
    process::run(&mut install).context("without cargo-mutants nothing can be changed")?;
    Ok(own)
}
