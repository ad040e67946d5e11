//! The test programs of the workspace: built by cargo, asked for their tests.

use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use arm_build::programs::{self, Program};
use arm_build::{process, workspace};

/// All programs of the test build.
#[derive(Debug)]
pub struct Built {
    programs: Vec<Program>,
}

impl Built {
    /// Builds all test programs in one call of cargo, with the programs that they run.
    ///
    /// # Errors
    /// If something does not compile.
    pub fn new(options: &[&str]) -> Result<Self> {
        let mut command = process::command(
            workspace::cargo(),
            &["test", "--locked", "--workspace", "--no-run"],
        );
        // Without examples, which no test runs.
        command.args(["--lib", "--bins", "--tests"]).args(options);
        let programs = programs::build(&mut command)?;
        ensure!(
            programs.iter().any(|program| program.is_test),
            "cargo names no test program"
        );
        Ok(Self { programs })
    }

    /// The test programs.
    pub fn tests(&self) -> impl Iterator<Item = &Program> {
        self.programs.iter().filter(|program| program.is_test)
    }

    /// The program of a name that is not a test.
    ///
    /// # Errors
    /// If there is none.
    pub fn binary(&self, name: &str) -> Result<&Path> {
        let found = self
            .programs
            .iter()
            .find(|program| !program.is_test && program.name == name);
        let program = found.with_context(|| format!("the test build has no program {name}"))?;
        Ok(&program.path)
    }
}

/// The program of the running test.
#[cfg(test)]
pub fn of_this_test() -> Program {
    Program {
        name: "xtask".to_owned(),
        path: std::env::current_exe().expect("a test has a path"),
        folder: env!("CARGO_MANIFEST_DIR").into(),
        is_test: true,
    }
}

/// A command that runs a program as cargo does.
pub fn command(program: &Program) -> Command {
    let mut command = Command::new(&program.path);
    command
        .current_dir(&program.folder)
        .env("CARGO_MANIFEST_DIR", &program.folder)
        .stdin(Stdio::null());
    command
}

/// Names of the tests of a program with their modules.
///
/// # Errors
/// If it does not list them.
pub fn list(program: &Program) -> Result<Vec<String>> {
    let listed = process::output(command(program).args(["--list", "--format", "terse"]));
    let lines =
        listed.with_context(|| format!("{} does not list its tests", program.path.display()))?;
    let tests = lines.lines().filter_map(|line| line.strip_suffix(": test"));
    Ok(tests.map(str::to_owned).collect())
}
