//! The programs that cargo builds, by its messages.

use std::path::PathBuf;
use std::process::{Command, Stdio};

use anyhow::{Result, ensure};

use crate::process;

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
    pub is_test: bool,
}

/// Runs a command of cargo that builds, and returns the programs that it names.
///
/// # Errors
/// If something does not compile.
pub fn build(command: &mut Command) -> Result<Vec<Program>> {
    command.args(["--message-format", "json-render-diagnostics"]);
    process::announce(command);
    let output = command.stderr(Stdio::inherit()).output()?;
    ensure!(
        output.status.success(),
        "{} failed; see above",
        process::shown(command)
    );
    let messages = String::from_utf8(output.stdout)?;
    Ok(messages.lines().filter_map(program).collect())
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

#[cfg(test)]
mod tests {
    use std::path::Path;

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
