//! Mutation test of the safety envelope: every change to its code has to be noticed by its tests.
//!
//! That takes minutes, so `firmware/mutants.txt` says for which code it was last done. Where a byte of that is
//! different, it is done again.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail, ensure};
use crc::{CRC_64_XZ, Crc};
use hitch_firmware::control::design_parameters::{SafetyParameters, SensorParameters};

use crate::{process, workspace};

/// What decides whether a change is noticed, besides the envelope's limits, from the workspace's root: the envelope,
/// what it is made of, its tests, and what is changed.
const DECIDES: [&str; 6] = [
    "firmware/src/control/safety",
    "firmware/src/control/mode.rs",
    "firmware/src/control/signals.rs",
    "firmware/src/control/units.rs",
    "firmware/tests/envelope",
    ".cargo/mutants.toml",
];
/// Says for which of it every change was noticed.
const PROVEN: &str = "firmware/mutants.txt";
/// The version that is installed where there is none; each knows a few changes more.
const VERSION: &str = "27.1.0";
/// Changes at a time.
const JOBS: &str = "2";
/// What cargo-mutants ends with if no change went unnoticed, but the tests of some didn't end in time.
const HANGS: i32 = 3;
/// Changes here make a loop endless, which on the ECU the watchdog notices; others only take long on a busy machine.
const LOOP: &str = "Debounce::judge";

/// Changes the envelope in every way and writes down that its tests have noticed; unless `again`, only if anything of
/// it is different from what was written down.
pub fn run(again: bool) -> Result<()> {
    let code = format!("code {:016x}", code()?);
    let proven = workspace::root().join(PROVEN);
    let known = fs::read_to_string(&proven).unwrap_or_default();
    if !again && known.lines().any(|line| line == code) {
        println!("{PROVEN}: its tests notice every change to the safety envelope as it is now");
        return Ok(());
    }
    println!("{PROVEN} does not know {code}");
    let folder = workspace::target().join("mutants");
    mutate(&folder)?;
    let found = |list: &str| {
        let path = folder.join("mutants.out").join(list);
        fs::read_to_string(&path).with_context(|| path.display().to_string())
    };
    let hang = found("timeout.txt")?;
    if let Some(slow) = hang.lines().find(|change| !change.ends_with(LOOP)) {
        bail!(
            "the tests took too long to say whether they notice this; try again when there is less to do: {slow}"
        );
    }
    let text = format!(
        "# Changes to the safety envelope, and how its tests notice them. Written by `cargo xtask mutants`.\n\
         {code}\nfail {}\nhang {}\ndon't compile {}\n",
        found("caught.txt")?.lines().count(),
        hang.lines().count(),
        found("unviable.txt")?.lines().count()
    );
    fs::write(&proven, text).with_context(|| format!("can't write {PROVEN}"))
}

/// A number that is another one if anything that decides is.
fn code() -> Result<u64> {
    let crc = Crc::<u64>::new(&CRC_64_XZ);
    let mut digest = crc.digest();
    let limits = (SafetyParameters::NOMINAL, SensorParameters::NOMINAL);
    digest.update(format!("{limits:?}").as_bytes());
    for path in DECIDES {
        for file in files(&workspace::root().join(path))? {
            let name = file.strip_prefix(workspace::root()).unwrap_or(&file);
            digest.update(name.as_os_str().as_encoded_bytes());
            digest.update(&fs::read(&file).with_context(|| file.display().to_string())?);
        }
    }
    Ok(digest.finalize())
}

/// The file itself, or the files in the folder, always in the same order.
fn files(path: &Path) -> Result<Vec<PathBuf>> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let entries = fs::read_dir(path).with_context(|| path.display().to_string())?;
    let mut files = entries
        .map(|entry| Ok(entry?.path()))
        .collect::<Result<Vec<_>>>()?;
    files.sort();
    Ok(files)
}

/// Runs cargo-mutants as `.cargo/mutants.toml` says.
fn mutate(folder: &Path) -> Result<()> {
    let mut command = process::command(program()?, &["mutants", "--jobs", JOBS]);
    command
        .args(["--package", "hitch-firmware", "--output"])
        .arg(folder)
        // Each job changes a copy of the sources and builds it there: in a folder that both share, or that the
        // sources themselves are built in, cargo would take what one copy has built for the other's.
        .env_remove("CARGO_TARGET_DIR");
    process::announce(&command);
    let status = command.status().context("can't start cargo-mutants")?;
    ensure!(
        status.success() || status.code() == Some(HANGS),
        "cargo-mutants: {status}; either a change goes unnoticed, see above, or the tests could not be run"
    );
    Ok(())
}

/// Finds cargo-mutants, or installs it beside what is built.
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
    // Its time passes in what it starts, so it needn't be optimised.
    let options = ["install", "--locked", "--debug", "--version", VERSION];
    let mut install = process::command(workspace::cargo(), &options);
    install.arg("--root").arg(folder).arg(NAME);
    process::run(&mut install).context("without cargo-mutants nothing can be changed")?;
    Ok(own)
}
