//! What each direct dependency of the program costs in a build from an empty folder.
//!
//! A dependency is charged with the packages that nothing else brings.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use arm_build::{process, workspace};
use toml::de::DeTable;

use crate::timings;

/// The program's package.
const PROGRAM: &str = "hitch-workbench";

/// What the crates of the program serve.
const SERVES: [(&str, &str); 7] = [
    ("hitch-campaign", "all that read logs"),
    ("hitch-ecu", "`ecu`, `record`, `flash-calibration`, `serve`"),
    (
        "hitch-ecu-host",
        "`ecu`, `record`, `flash-calibration`, `serve`",
    ),
    ("hitch-fmu", "`export-fmu`"),
    ("hitch-mdf-file", "all that read logs"),
    ("hitch-page", "`serve`"),
    (
        "hitch-protocols",
        "`ecu`, `record`, `flash-calibration`, `serve`",
    ),
];

/// The packages of the lock file: those that each depends on, by name.
struct Lock {
    dependencies: BTreeMap<String, BTreeSet<String>>,
    /// Those of the workspace.
    own: BTreeSet<String>,
}

/// A row of the table.
struct Row {
    name: String,
    users: BTreeSet<String>,
    packages: usize,
    seconds: f64,
    megabytes: f64,
}

/// Builds the program into an empty folder, and prints the table.
///
/// # Errors
/// If it does not compile.
pub fn run() -> Result<()> {
    let folder = workspace::target().join("dependencies");
    let _ = fs::remove_dir_all(&folder);
    let arguments = [
        "build",
        "--release",
        "--locked",
        "--timings",
        "--target-dir",
    ];
    process::run(process::command(workspace::cargo(), &arguments).arg(&folder))?;
    let mut seconds: BTreeMap<String, f64> = BTreeMap::new();
    for unit in timings::units(&folder)? {
        *seconds.entry(unit.package).or_default() += unit.seconds;
    }
    let sizes = library_sizes(&folder.join("release/deps"))?;
    let lock = Lock::read()?;
    let mut rows = lock.rows(&seconds, &sizes)?;
    rows.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    println!(
        "\n| dependency | of | serves | packages | s of one core | MB of libraries |\n|---|---|---|---|---|---|"
    );
    let (own, shared): (Vec<&Row>, Vec<&Row>) = rows.iter().partition(|row| row.packages > 0);
    for row in own {
        let serves = |user: &String| SERVES.iter().find(|(name, _)| name == user);
        let served: BTreeSet<&str> = row
            .users
            .iter()
            .map(|user| serves(user).map_or("all", |(_, served)| served))
            .collect();
        let served = if served.contains("all") {
            "all".to_owned()
        } else {
            join(&served)
        };
        println!(
            "| {} | {} | {served} | {} | {:.1} | {:.1} |",
            row.name,
            join(&row.users),
            row.packages,
            row.seconds,
            row.megabytes
        );
    }
    let shared: BTreeSet<&str> = shared.iter().map(|row| row.name.as_str()).collect();
    println!("\nShared with others: {}.", join(&shared));
    Ok(())
}

fn join<S: AsRef<str>>(texts: &BTreeSet<S>) -> String {
    let texts: Vec<&str> = texts.iter().map(AsRef::as_ref).collect();
    texts.join(", ")
}

/// Sizes of the libraries in a folder by the names of their packages, MB.
fn library_sizes(folder: &Path) -> Result<BTreeMap<String, f64>> {
    let mut sizes: BTreeMap<String, f64> = BTreeMap::new();
    for file in workspace::files(folder)? {
        let name = file.file_stem().and_then(|name| name.to_str());
        let name = name.and_then(|name| name.strip_prefix("lib")?.split_once('-'));
        let is_library = file.extension().is_some_and(|end| end == "rlib");
        if let Some((name, _)) = name.filter(|_| is_library) {
            let size = fs::metadata(&file)?.len() as f64 / 1e6;
            *sizes.entry(name.replace('_', "-")).or_default() += size;
        }
    }
    Ok(sizes)
}

impl Lock {
    fn read() -> Result<Self> {
        let text = fs::read_to_string(workspace::root().join("Cargo.lock"))?;
        let table = DeTable::parse(&text)?.into_inner();
        let packages = table
            .get("package")
            .and_then(|list| list.get_ref().as_array());
        let (mut dependencies, mut own) = (BTreeMap::new(), BTreeSet::new());
        for package in packages.context("the lock file has no packages")? {
            let package = package
                .get_ref()
                .as_table()
                .context("a package is no table")?;
            let name = package.get("name").and_then(|name| name.get_ref().as_str());
            let name = name.context("a package has no name")?.to_owned();
            let list = package
                .get("dependencies")
                .and_then(|list| list.get_ref().as_array());
            let list = list.into_iter().flatten();
            // A name may be followed by a version.
            let names = list.filter_map(|one| one.get_ref().as_str()?.split(' ').next());
            if !package.contains_key("source") {
                own.insert(name.clone());
            }
            let known: &mut BTreeSet<String> = dependencies.entry(name).or_default();
            known.extend(names.map(str::to_owned));
        }
        Ok(Self { dependencies, own })
    }

    /// The rows of the program's direct dependencies.
    fn rows(
        &self,
        seconds: &BTreeMap<String, f64>,
        sizes: &BTreeMap<String, f64>,
    ) -> Result<Vec<Row>> {
        let packages = crate::test::packages()?;
        let crates = packages
            .iter()
            .filter(|(name, _)| seconds.contains_key(*name));
        let mut users: BTreeMap<&String, BTreeSet<String>> = BTreeMap::new();
        for (name, package) in crates {
            let foreign = package
                .needed
                .iter()
                .filter(|other| !self.own.contains(*other));
            for dependency in foreign.filter(|other| seconds.contains_key(*other)) {
                users.entry(dependency).or_default().insert(name.clone());
            }
        }
        let all = self.reached("");
        let row = |(dependency, users): (&String, BTreeSet<String>)| {
            let rest = self.reached(dependency);
            let only: Vec<&String> = all
                .difference(&rest)
                .filter(|name| seconds.contains_key(**name))
                .copied()
                .collect();
            let sum = |of: &BTreeMap<String, f64>| {
                only.iter()
                    .filter_map(|name| of.get(*name))
                    .fold(0.0, |sum, one| sum + one)
            };
            Row {
                name: dependency.clone(),
                users,
                packages: only.len(),
                seconds: sum(seconds),
                megabytes: sum(sizes),
            }
        };
        Ok(users.into_iter().map(row).collect())
    }

    /// Names of the packages that the program reaches, if none of its own crates had a dependency.
    fn reached(&self, without: &str) -> BTreeSet<&String> {
        let mut reached = BTreeSet::new();
        let mut open: Vec<&String> = self.own.iter().filter(|name| *name == PROGRAM).collect();
        while let Some(name) = open.pop() {
            if !reached.insert(name) {
                continue;
            }
            let cut = self.own.contains(name);
            let next = self.dependencies.get(name).into_iter().flatten();
            open.extend(next.filter(|next| !(cut && *next == without)));
        }
        reached
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dependency_is_charged_with_what_nothing_else_brings() {
        let lock = Lock::read().unwrap();
        let (all, without) = (lock.reached(""), lock.reached("falcon_mdf"));
        let only: Vec<&str> = all.difference(&without).map(|name| name.as_str()).collect();
        assert!(
            only.contains(&"falcon_mdf") && only.contains(&"quick-xml"),
            "{only:?}"
        );
        assert!(
            !only.contains(&"flate2") && !only.contains(&"thiserror"),
            "{only:?}"
        );
    }
}
