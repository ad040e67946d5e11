//! The packages that a change concerns: those with changed files, and all that depend on them.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use arm_build::{process, workspace};
use toml::de::{DeTable, DeValue};

/// Files of the workspace that concern every package.
const SHARED: [&str; 3] = ["Cargo.toml", "Cargo.lock", ".cargo/config.toml"];

/// A package of the workspace.
pub struct Package {
    /// Its folder, from the workspace's root.
    pub folder: PathBuf,
    /// Names of the packages that it depends on, without those of its tests.
    pub needed: BTreeSet<String>,
    /// Names of the packages that it or its tests depend on.
    dependencies: BTreeSet<String>,
}

/// Folders of the packages that the changes since a commit concern, committed or not.
///
/// # Errors
/// If git does not know the commit, or a manifest cannot be read.
pub fn since(commit: &str) -> Result<BTreeSet<PathBuf>> {
    let git = |arguments: &[&str]| {
        process::output(&mut process::command("git", arguments))
            .with_context(|| format!("git {} fails or prints nothing", arguments.join(" ")))
    };
    git(&["rev-parse", "--verify", commit])?;
    let changed = git(&["diff", "--name-only", commit]).unwrap_or_default();
    let new = git(&["ls-files", "--others", "--exclude-standard"]).unwrap_or_default();
    let files: Vec<&str> = changed.lines().chain(new.lines()).collect();
    let packages = packages()?;
    let names = concerned(&packages, &files);
    let folders = packages
        .into_iter()
        .filter(|(name, _)| names.contains(name));
    Ok(folders.map(|(_, package)| package.folder).collect())
}

/// Names of the packages with these files, and of all that depend on them.
fn concerned(packages: &BTreeMap<String, Package>, files: &[&str]) -> BTreeSet<String> {
    if files.iter().any(|file| SHARED.contains(file)) {
        return packages.keys().cloned().collect();
    }
    let owner = |file: &&str| {
        let holds = |package: &Package| Path::new(file).starts_with(&package.folder);
        let holding = packages.iter().filter(|(_, package)| holds(package));
        let nearest = holding.max_by_key(|(_, package)| package.folder.components().count());
        nearest.map(|(name, _)| name.clone())
    };
    let mut names: BTreeSet<String> = files.iter().filter_map(owner).collect();
    loop {
        let depends = |package: &Package| !package.dependencies.is_disjoint(&names);
        let more = packages.iter().filter(|(_, package)| depends(package));
        let more: BTreeSet<String> = more.map(|(name, _)| name.clone()).collect();
        if more.is_subset(&names) {
            return names;
        }
        names.extend(more);
    }
}

/// The packages of the workspace by their names.
///
/// # Errors
/// If a manifest cannot be read.
pub fn packages() -> Result<BTreeMap<String, Package>> {
    let text = manifest(Path::new(""))?;
    let root = DeTable::parse(&text)?.into_inner();
    let members = table(&root, "workspace").and_then(|workspace| workspace.get("members"));
    let members = members.and_then(|members| members.get_ref().as_array());
    let members = members.context("the workspace has no members")?;
    let folder = |member| DeValue::as_str(member).context("a member is no text");
    members
        .iter()
        .map(|member| package(folder(member.get_ref())?.into()))
        .collect()
}

/// Name and package of a folder.
fn package(folder: PathBuf) -> Result<(String, Package)> {
    let text = manifest(&folder)?;
    let manifest = DeTable::parse(&text)?.into_inner();
    let name = table(&manifest, "package").and_then(|package| package.get("name"));
    let name = name.and_then(|name| name.get_ref().as_str());
    let name = name.with_context(|| format!("{} has no name", folder.display()))?;
    let [mut needed, mut dependencies] = [BTreeSet::new(), BTreeSet::new()];
    add_dependencies(&manifest, "dev-", &mut needed);
    add_dependencies(&manifest, "none", &mut dependencies);
    let package = Package {
        folder,
        needed,
        dependencies,
    };
    Ok((name.to_owned(), package))
}

fn table<'t>(outer: &'t DeTable<'_>, key: &str) -> Option<&'t DeTable<'t>> {
    outer.get(key)?.get_ref().as_table()
}

/// Adds the names in each table of dependencies, those for some targets too, without tables whose names begin with `omit`.
fn add_dependencies(table: &DeTable<'_>, omit: &str, names: &mut BTreeSet<String>) {
    for (key, value) in table {
        let Some(inner) = value.get_ref().as_table() else {
            continue;
        };
        if key.get_ref().starts_with(omit) {
            continue;
        }
        if key.get_ref().ends_with("dependencies") {
            names.extend(inner.keys().map(|name| name.get_ref().to_string()));
        } else {
            add_dependencies(inner, omit, names);
        }
    }
}

fn manifest(folder: &Path) -> Result<String> {
    let path = workspace::root().join(folder).join("Cargo.toml");
    fs::read_to_string(&path).with_context(|| path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(files: &[&str]) -> BTreeSet<String> {
        concerned(&packages().unwrap(), files)
    }

    #[test]
    fn a_change_concerns_its_package_and_all_that_depend_on_it() {
        let plant = names(&["model/plant/src/lib.rs"]);
        for name in [
            "hitch-plant",
            "hitch-effects",
            "hitch-workbench",
            "host-tests",
        ] {
            assert!(plant.contains(name), "{name}: {plant:?}");
        }
        for name in ["hitch-safety", "hitch-input", "xtask"] {
            assert!(!plant.contains(name), "{name}: {plant:?}");
        }
        let board = names(&["host-tests/board-emulator/src/cpu.rs"]);
        assert_eq!(
            board,
            ["board-emulator", "host-tests"].map(str::to_owned).into()
        );
    }

    #[test]
    fn a_document_concerns_none_and_the_lock_file_all() {
        assert!(names(&["docs/plant.md"]).is_empty());
        assert_eq!(names(&["Cargo.lock"]).len(), packages().unwrap().len());
    }
}
