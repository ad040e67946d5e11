//! Ablations: what a benchmark loses if one heuristic is removed.
//!
//! `xtask/ablations.toml` lists the heuristics. Each entry replaces a piece of source text by a version without the
//! heuristic. All entries are compiled into one copy of the workspace, each behind a switch that an environment
//! variable sets, so that the benchmark is built once and run once per heuristic.

mod battery;
mod list;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use arm_build::{process, workspace};

use battery::{Battery, Outcome};
use list::Ablation;

/// Checks that each entry of the list still matches the source.
pub fn check() -> Result<()> {
    let root = workspace::root();
    for ablation in list::read()? {
        ablation.check(&root)?;
    }
    Ok(())
}

/// Runs the benchmark of a part without its heuristics. `sets` selects the rows: names joined by `+` are removed
/// together; without any, each heuristic is removed alone.
pub fn run(arguments: &[String]) -> Result<()> {
    let Some((part, sets)) = arguments.split_first() else {
        bail!("which part: identification or control?");
    };
    let battery: Battery = part.parse()?;
    let mut ablations = list::read()?;
    ablations.retain(|ablation| ablation.part == battery);
    let each = ablations.iter().map(|ablation| ablation.name.clone());
    let sets = if sets.is_empty() {
        each.collect()
    } else {
        sets.to_vec()
    };
    let removed: Vec<String> = sets
        .iter()
        .map(|set| removed_by(set, &ablations))
        .collect::<Result<_>>()?;
    let folder = copied(&ablations)?;
    let program = battery.build(&folder)?;
    let whole = battery.run(&program, None)?;
    println!("{}", battery.header());
    println!("{}", battery.row("(none)", &whole, &whole));
    for (set, removed) in sets.iter().zip(removed) {
        let without: Outcome = battery.run(&program, Some(set))?;
        println!("{}", battery.row(&removed, &whole, &without));
    }
    Ok(())
}

/// What a set of names joined by `+` removes, for the table.
fn removed_by(set: &str, ablations: &[Ablation]) -> Result<String> {
    let texts: Vec<&str> = set
        .split('+')
        .map(|name| {
            let named = ablations.iter().find(|ablation| ablation.name == name);
            named
                .map(|ablation| ablation.removes.as_str())
                .with_context(|| {
                    format!("xtask/ablations.toml has no heuristic {name} of this part")
                })
        })
        .collect::<Result<_>>()?;
    Ok(texts.join(", and "))
}

/// A copy of the workspace with every entry behind its switch.
fn copied(ablations: &[Ablation]) -> Result<PathBuf> {
    let root = workspace::root();
    let folder = workspace::target().join("ablation/source");
    let listed = process::output(&mut process::command("git", &["ls-files"]));
    let files = listed.context("git can't list the files of the workspace")?;
    remove_others(&folder, &files)?;
    for file in files.lines() {
        let (from, to) = (root.join(file), folder.join(file));
        if !from.is_file() {
            continue;
        }
        let mut bytes = fs::read(&from).with_context(|| from.display().to_string())?;
        let own = ablations.iter().filter(|ablation| ablation.file == file);
        for ablation in own {
            let text = String::from_utf8(bytes).with_context(|| file.to_owned())?;
            bytes = ablation.applied_to(&text)?.into_bytes();
        }
        // Unchanged files keep their time stamps, so that cargo does not build them again.
        if fs::read(&to).ok().as_deref() != Some(&bytes) {
            fs::create_dir_all(to.parent().context("a file has a folder")?)?;
            fs::write(&to, bytes).with_context(|| to.display().to_string())?;
        }
    }
    Ok(folder)
}

/// Removes files of an earlier copy that the workspace no longer has.
fn remove_others(folder: &Path, files: &str) -> Result<()> {
    let listed: BTreeSet<PathBuf> = files.lines().map(|file| folder.join(file)).collect();
    if folder.is_dir() {
        for file in workspace::files(folder)? {
            if !listed.contains(&file)
                || !workspace::root().join(file.strip_prefix(folder)?).exists()
            {
                fs::remove_file(&file)?;
            }
        }
    }
    Ok(())
}
