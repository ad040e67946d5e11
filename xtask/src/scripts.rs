//! The types of the scripts of the page and the reports, checked by the TypeScript compiler.

use std::fs;

use anyhow::{Context, Result};
use arm_build::{process, setup, workspace};

/// What is checked, and how, from the workspace's root.
const PROJECT: &str = "workbench/jsconfig.json";

/// Name and text of each file that pins the compiler.
const PINNED: [(&str, &str); 2] = [
    ("package.json", include_str!("../typescript/package.json")),
    (
        "package-lock.json",
        include_str!("../typescript/package-lock.json"),
    ),
];

/// The compiler, installed once below the target folder.
const COMPILER: &str = "node_modules/typescript/bin/tsc";

/// Installs the compiler if it is missing, and refuses scripts with type errors.
pub fn check() -> Result<()> {
    let folder = workspace::target().join("typescript");
    let compiler = folder.join(COMPILER);
    let is_present = |(name, text): (&str, &str)| {
        fs::read_to_string(folder.join(name)).is_ok_and(|present| present == text)
    };
    setup::NODE.find()?;
    setup::NPM.find()?;
    if !compiler.exists() || !PINNED.into_iter().all(is_present) {
        fs::create_dir_all(&folder).with_context(|| folder.display().to_string())?;
        for (name, text) in PINNED {
            let path = folder.join(name);
            fs::write(&path, text).with_context(|| path.display().to_string())?;
        }
        let arguments = ["ci", "--ignore-scripts", "--no-audit", "--no-fund"];
        process::run(process::command("npm", &arguments).current_dir(&folder))
            .context("the TypeScript compiler cannot be installed")?;
    }
    let mut compile = process::command("node", &[]);
    compile.arg(&compiler).args(["--project", PROJECT]);
    process::run(&mut compile).context("the scripts have type errors, listed above")
}
