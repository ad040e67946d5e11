//! The test programs of the workspace: built by cargo, asked for their tests.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use arm_build::{process, workspace};

/// A program that cargo has built.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// Name of its target: of the crate for unit tests, of the file or folder for others.
    pub name: String,
    /// The executable.
    pub path: PathBuf,
    /// Folder of its package, in which cargo runs tests.
    pub folder: PathBuf,
    /// Whether it has the harness of tests.
    is_test: bool,
}

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
        command
            .args(["--lib", "--bins", "--tests"])
            .args(["--message-format", "json-render-diagnostics"])
            .args(options);
        process::announce(&command);
        let output = command.stderr(Stdio::inherit()).output()?;
        ensure!(
            output.status.success(),
            "the tests don't compile; see above"
        );
        let messages = String::from_utf8(output.stdout)?;
        let programs: Vec<Program> = messages.lines().filter_map(program).collect();
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

/// The program of a message of cargo.
fn program(message: &str) -> Option<Program> {
    let text = |key: &str, within: &str| {
        let (_, rest) = within.split_once(&format!("\"{key}\":\""))?;
        Some(rest.split_once('"')?.0.to_owned())
    };
    let path = text("executable", message)?;
    let manifest = PathBuf::from(text("manifest_path", message)?);
    let (_, target) = message.split_once("\"target\":{")?;
    let (_, profile) = message.split_once("\"profile\":{")?;
    Some(Program {
        name: text("name", target)?.replace('-', "_"),
        path: path.into(),
        folder: manifest.parent()?.to_owned(),
        is_test: profile.split('}').next()?.contains("\"test\":true"),
    })
}

impl Program {
    /// The program of the running test.
    #[cfg(test)]
    pub fn of_this_test() -> Self {
        Self {
            name: "xtask".to_owned(),
            path: std::env::current_exe().expect("a test has a path"),
            folder: env!("CARGO_MANIFEST_DIR").into(),
            is_test: true,
        }
    }

    /// A command that runs it as cargo does.
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.path);
        command
            .current_dir(&self.folder)
            .env("CARGO_MANIFEST_DIR", &self.folder)
            .stdin(Stdio::null());
        command
    }

    /// Names of its tests with their modules.
    ///
    /// # Errors
    /// If it does not list them.
    pub fn list(&self) -> Result<Vec<String>> {
        let mut command = self.command();
        command.args(["--list", "--format", "terse"]);
        let output = command
            .output()
            .with_context(|| format!("can't start {}", self.path.display()))?;
        ensure!(
            output.status.success(),
            "{} does not list its tests",
            self.path.display()
        );
        let lines = String::from_utf8(output.stdout)?;
        let tests = lines.lines().filter_map(|line| line.strip_suffix(": test"));
        Ok(tests.map(str::to_owned).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_come_from_the_messages_of_cargo() {
        let message = |test: bool, executable: &str| {
            format!(
                "{{\"reason\":\"compiler-artifact\",\"package_id\":\"p\",\"manifest_path\":\"/w/a/Cargo.toml\",\"target\":{{\
                 \"kind\":[\"test\"],\"crate_types\":[\"bin\"],\"name\":\"board-bench\",\"test\":true}},\"profile\":{{\
                 \"opt_level\":\"1\",\"test\":{test}}},\"features\":[],\"executable\":{executable},\"fresh\":true}}"
            )
        };
        let found = program(&message(true, "\"/t/board_bench-1\"")).unwrap();
        assert!(found.is_test && found.name == "board_bench");
        assert_eq!(found.folder, Path::new("/w/a"));
        assert_eq!(found.path, Path::new("/t/board_bench-1"));
        assert!(
            !program(&message(false, "\"/t/board-bench\""))
                .unwrap()
                .is_test
        );
        assert_eq!(program(&message(false, "null")), None, "a library");
    }
}
