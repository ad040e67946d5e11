//! Coverage of the safety envelope: its tests have to reach each region of its code, and therefore each line, and each
//! outcome of its branches.
//!
//! A region is the code between two branches, so a line with a condition has several. A branch is a condition of `if`,
//! `match`, `&&` and `||`, which has to be true and false. Counters of branches are an unstable option of the compiler, which is
//! enabled for this build alone.

use std::collections::{BTreeMap, BTreeSet};
use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use anyhow::{Context, Result, bail, ensure};
use arm_build::{process, programs, workspace};
use llvm_profparser::{CoverageMapping, merge_profiles};

use crate::branches::{self, Place, Taken};

/// The covered files, relative to the workspace's root: the envelope, and the rows of its table.
const COVERED: [&str; 2] = [
    "firmware/safety/src",
    "firmware/quantities/src/signals/trip.rs",
];
/// Environment variable that marks a start of this program by cargo in place of the compiler.
const COUNTING: &str = "HITCH_COUNTING_RUSTC";

/// Runs the envelope's tests with counters, and reports regions that no test reached.
pub fn run() -> Result<()> {
    let folder = workspace::target().join("coverage");
    // Counters of earlier runs belong to other programs.
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).with_context(|| format!("can't make {}", folder.display()))?;
    let tests = ["--package", "hitch-safety", "--test", "envelope"];
    let test = build(&tests, &folder)?;
    let counters = folder.join("envelope.profraw");
    process::run(
        Command::new(&test)
            .arg("--quiet")
            .env("LLVM_PROFILE_FILE", &counters),
    )?;
    let profile = merge_profiles(&[counters]).context("can't read the counters")?;
    let objects = [test];
    let mapping = CoverageMapping::new(&objects, &profile, true)?;
    let counted = branches::counted(&mapping, &profile, &workspace::root(), &COVERED)?;
    judge(&counted.pieces)?;
    judge_branches(&counted.branches)
}

/// Lists the outcomes that no test has. They are an error.
fn judge_branches(branches: &BTreeMap<Place, Taken>) -> Result<()> {
    let open = branches
        .iter()
        .filter_map(|((file, [line, column, ..]), taken)| {
            let what = taken.open()?;
            Some(format!("{}:{line}:{column} is {what}", file.display()))
        })
        .collect::<Vec<_>>();
    open.iter().for_each(|line| println!("{line}"));
    println!(
        "the safety envelope: {} of {} branches are true and false in its tests",
        branches.len() - open.len(),
        branches.len()
    );
    ensure!(
        open.is_empty(),
        "the envelope's tests leave outcomes of branches out; see above. A test has to show the requirement behind each, \
         or the condition is redundant"
    );
    Ok(())
}

/// Compiles a test with counters; returns the program. Counters of build scripts are written to `folder`.
fn build(tests: &[&str], folder: &Path) -> Result<PathBuf> {
    let mut command = process::command(workspace::cargo(), &["test", "--locked", "--no-run"]);
    command.args(tests);
    // Only the workspace's crates have counters, so their dependencies are not compiled again.
    let this = env::current_exe().context("where is this program?")?;
    command
        .env("RUSTC_WORKSPACE_WRAPPER", this)
        .env("LLVM_PROFILE_FILE", folder.join("build.profraw"))
        .env(COUNTING, "1");
    // Of all artefacts reported by cargo only the test is a program.
    let program = programs::build(&mut command)?.into_iter().next();
    Ok(program.context("cargo names no test program")?.path)
}

/// If cargo has started this program in place of the compiler: compiles with counters.
pub fn compile() -> Option<ExitCode> {
    env::var_os(COUNTING)?;
    let mut arguments = env::args_os().skip(1);
    let compiler: OsString = arguments.next()?;
    let status = Command::new(compiler)
        .args(arguments)
        .args(["-C", "instrument-coverage", "-Z", "coverage-options=branch"])
        .env("RUSTC_BOOTSTRAP", "1")
        .status();
    Some(match status {
        Ok(status) if status.success() => ExitCode::SUCCESS,
        _ => ExitCode::FAILURE,
    })
}

/// Lists the pieces of code that no test reaches. They are an error.
fn judge(pieces: &BTreeMap<Place, i64>) -> Result<()> {
    let mut missed = 0;
    let (mut files, mut lines) = (BTreeSet::new(), BTreeSet::new());
    for ((file, [line, column, last, _]), hits) in pieces {
        if *hits == 0 {
            println!("{}:{line}:{column} is never reached", file.display());
            missed += 1;
        }
        files.insert(file);
        lines.extend((*line..=*last).map(|line| (file, line)));
    }
    println!(
        "the safety envelope: {} of {} pieces of code on {} lines of {} files are reached by its tests",
        pieces.len() - missed,
        pieces.len(),
        lines.len(),
        files.len()
    );
    let mut sources = 0;
    for covered in COVERED {
        sources += workspace::files(&workspace::root().join(covered))?.len();
    }
    if files.len() != sources {
        bail!(
            "{} have {sources} files, of which {} were looked at",
            COVERED.join(" and "),
            files.len()
        );
    }
    ensure!(
        missed == 0,
        "the envelope's tests leave code out; see above"
    );
    Ok(())
}
