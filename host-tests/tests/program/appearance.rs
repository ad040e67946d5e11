//! Texts of the program: their width, and their colours.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use host_tests::program::{hitch, run};

use crate::small_campaign::campaign;

/// Width of a text that is not for a terminal, characters.
const WIDTH: usize = 80;

/// The text of a command that has to succeed.
fn text(folder: &Path, arguments: &str) -> String {
    let output = run(folder, &arguments.split(' ').collect::<Vec<_>>());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments}: {said}");
    String::from_utf8(output.stdout).unwrap()
}

/// Every line fits, and is not coloured.
fn assert_fits(text: &str) {
    assert!(!text.is_empty());
    for line in text.lines() {
        assert!(line.chars().count() <= WIDTH, "{line:?} in\n{text}");
        assert!(!line.contains('\x1b'), "{line:?}");
    }
}

#[test]
fn texts_on_a_campaign_fit_80_columns() {
    let dir = campaign();
    for arguments in [
        "compare .",
        "diagnose .",
        "explain .",
        "changes . .",
        "model fit . --out fitted.toml",
        "diagnose . --model fitted.toml",
    ] {
        assert_fits(&text(dir.path(), arguments));
    }
}

#[test]
fn texts_of_the_closed_loop_and_the_effects_fit_80_columns() {
    let dir = tempfile::tempdir().unwrap();
    for arguments in [
        "loop --scenario quick",
        "loop --scenario rate --load 150",
        "tune --scenario quick --trials 10 --out tuned.toml --force",
        "calibrate nominal --out calibration.toml",
        "effects",
        "effects oil-viscosity/flow-number",
        "effects --formulas",
    ] {
        assert_fits(&text(dir.path(), arguments));
    }
    // Too heavy to lift: an error, after the table.
    let missed = run(
        dir.path(),
        &["loop", "--scenario", "ends", "--load", "2000"],
    );
    assert_eq!(missed.status.code(), Some(2));
    assert_fits(&String::from_utf8(missed.stdout).unwrap());
}

#[test]
fn texts_of_imports_models_and_the_ecu_fit_80_columns() {
    let dir = campaign();
    let log = fs::read_to_string(dir.path().join("lower_2.2A_150kg.csv")).unwrap();
    // Names of a length that some loggers give.
    let (_, rows) = log.split_once('\n').unwrap();
    let names = log
        .lines()
        .next()
        .unwrap()
        .split(',')
        .map(|name| match name {
            "time_s" => "time [s]".to_owned(),
            name => format!(
                "Bench 7 / hydraulics / {} / filtered",
                name.replace('_', " ")
            ),
        });
    let names: Vec<String> = names.collect();
    let long = "a log with a name of the length that loggers of whole days use 150kg.csv";
    fs::write(
        dir.path().join(long),
        format!("{}\n{rows}", names.join(",")),
    )
    .unwrap();
    let import = ["import", long, "--out", "i", "--yes"];
    let output = run(dir.path(), &import);
    assert!(output.status.success(), "{output:?}");
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(said.contains("next: hitch compare i"), "{said}");
    assert_fits(&said);
    for arguments in [
        "model new --yes --out new.toml",
        "ecu --host --seconds 1.2",
        "ecu --host --seconds 1.2 --can 127.0.0.1:0",
    ] {
        assert_fits(&text(dir.path(), arguments));
    }
}

/// Output of `hitch compare` with an environment in place of that of the test.
fn compared(folder: &Path, environment: &[(&str, &str)]) -> Output {
    let mut command: Command = hitch();
    for name in ["NO_COLOR", "CLICOLOR", "CLICOLOR_FORCE"] {
        command.env_remove(name);
    }
    command.envs(environment.iter().copied());
    command.args(["compare", "."]).current_dir(folder);
    command.output().unwrap()
}

#[test]
fn colours_are_for_terminals() {
    let dir = campaign();
    let is_coloured =
        |environment: &[(&str, &str)]| compared(dir.path(), environment).stdout.contains(&b'\x1b');
    assert!(!is_coloured(&[]), "a pipe is not a terminal");
    let forced = ("CLICOLOR_FORCE", "1");
    assert!(is_coloured(&[forced]), "errors are marked");
    assert!(!is_coloured(&[forced, ("NO_COLOR", "1")]));
    // Colours change nothing else.
    let coloured = compared(dir.path(), &[forced]).stdout;
    let stripped = anstream::adapter::strip_bytes(&coloured).into_vec();
    assert_eq!(stripped, compared(dir.path(), &[]).stdout);
}

#[test]
fn the_name_of_the_program_before_an_error_is_coloured_for_terminals() {
    let dir = tempfile::tempdir().unwrap();
    let plain = compared(dir.path(), &[]);
    assert_eq!(plain.status.code(), Some(2));
    assert!(plain.stderr.starts_with(b"hitch: "), "{plain:?}");
    let forced = compared(dir.path(), &[("CLICOLOR_FORCE", "1")]);
    assert!(forced.stderr.starts_with(b"\x1b["), "{forced:?}");
}

#[test]
fn a_terminal_has_colours_and_its_own_width() {
    // `script`, of util-linux, runs a command on a terminal.
    let dir = campaign();
    let program = hitch().get_program().to_string_lossy().into_owned();
    let command = format!("stty cols 100; {program} compare .");
    let mut script = Command::new("script");
    script
        .args(["-qec", &command, "/dev/null"])
        .env_remove("NO_COLOR")
        .env("TERM", "xterm-256color")
        .current_dir(dir.path());
    let Ok(output) = script.output() else {
        println!("script is not installed");
        return;
    };
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("\x1b["), "{said}");
}
