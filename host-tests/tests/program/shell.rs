//! Completions, manual pages and help: how a shell and its user learn the commands.

use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use clap::CommandFactory;
use hitch_workbench::cli::Cli;
use host_tests::program::run;

/// Standard output of a command that has to succeed without a message.
fn printed(arguments: &[&str]) -> String {
    let output = run(Path::new("."), arguments);
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{arguments:?}: {output:?}"
    );
    String::from_utf8(output.stdout).unwrap()
}

/// The words of all commands, as in `["model", "fit"]`.
fn commands(command: &clap::Command, above: &[String]) -> Vec<Vec<String>> {
    let of = |inner: &clap::Command| {
        let words = [above, &[inner.get_name().to_owned()]].concat();
        let mut all = commands(inner, &words);
        all.push(words);
        all
    };
    command.get_subcommands().flat_map(of).collect()
}

/// Has a shell read a script without running it; whether the shell is installed.
fn is_accepted(shell: &str, script: &str) -> Option<bool> {
    let mut command = Command::new(shell);
    command.arg("-n").stdin(Stdio::piped());
    let mut child = command.spawn().ok()?;
    child.stdin.take()?.write_all(script.as_bytes()).ok()?;
    Some(child.wait().ok()?.success())
}

#[test]
fn every_shell_gets_completions_that_it_accepts() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = printed(&["completions", shell]);
        assert!(
            script.contains("diagnose") && script.contains("budget"),
            "{shell}"
        );
        if ["bash", "zsh", "fish"].contains(&shell) {
            match is_accepted(shell, &script) {
                Some(accepted) => assert!(accepted, "{shell} rejects its completions"),
                None => println!("{shell} is not installed"),
            }
        }
    }
    let refused = run(Path::new("."), &["completions", "csh"]);
    assert_eq!(refused.status.code(), Some(2));
}

#[test]
fn every_command_has_help_and_a_page() {
    for words in commands(&Cli::command(), &[]) {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let help = printed(&[&["help"], &words[..]].concat());
        assert!(
            help.contains(&format!("Usage: hitch {}", words.join(" "))),
            "{help}"
        );
        let page = printed(&[&["man"], &words[..]].concat());
        let name = format!("hitch-{}", words.join("-")).replace('-', "\\-");
        assert!(page.contains(".TH ") && page.contains(&name), "{page}");
    }
    let page = printed(&["man"]);
    assert!(
        page.contains(".SH SUBCOMMANDS") && page.contains("explain"),
        "{page}"
    );
    let refused = run(Path::new("."), &["man", "explian"]);
    assert_eq!(refused.status.code(), Some(2));
}
