//! Results in `docs/BENCHMARKS.md`, written by the commands that measure them.
//!
//! A result stands between two comments. The first one names it and holds its command:
//!
//! ```text
//! <!-- result effects: hitch effects -->
//! ...
//! <!-- end -->
//! ```
//!
//! `hitch` is the program that this task builds. A line with a date, the commit, the processor and the time follows the
//! first comment, then the standard output of the command: a Markdown table as it is, other text as a code block.

use std::fs;
use std::process::Command;
use std::time::Instant;

use anyhow::{Context, Result, bail, ensure};
use arm_build::{process, workspace};

/// The document, relative to the workspace's root.
const DOCUMENT: &str = "docs/BENCHMARKS.md";

const BEGIN: &str = "<!-- result ";
const END: &str = "<!-- end -->";

/// Measures the named results again, or all, and writes them into the document.
pub fn run(names: &[String]) -> Result<()> {
    let path = workspace::root().join(DOCUMENT);
    let mut text = fs::read_to_string(&path).context(DOCUMENT)?;
    let results = results(&text)?;
    for name in names {
        ensure!(
            results.iter().any(|result| result.name == *name),
            "{DOCUMENT} has no result {name}"
        );
    }
    process::run(&mut process::command(
        workspace::cargo(),
        &[
            "build",
            "--release",
            "--locked",
            "--package",
            "hitch-workbench",
        ],
    ))?;
    let machine = machine()?;
    for result in results {
        if names.is_empty() || names.contains(&result.name) {
            let (output, seconds) = measured(&result.command)?;
            let line = format!("{machine}, {seconds:.0} s:");
            text = replaced(&text, &result, &format!("{line}\n\n{}", shown(&output)))?;
            // Written after each result: all of them take hours.
            fs::write(&path, &text).context(DOCUMENT)?;
        }
    }
    Ok(())
}

/// A result of the document.
#[derive(Debug, PartialEq)]
struct Marked {
    name: String,
    command: String,
}

/// The results of a document.
fn results(text: &str) -> Result<Vec<Marked>> {
    let begins = text.lines().filter(|line| line.starts_with(BEGIN));
    let results = begins.map(|line| {
        let inner = line[BEGIN.len()..].strip_suffix(" -->");
        let (name, command) = inner
            .and_then(|inner| inner.split_once(": "))
            .with_context(|| format!("{DOCUMENT}: `{line}` is not `{BEGIN}NAME: COMMAND -->`"))?;
        Ok(Marked {
            name: name.to_owned(),
            command: command.to_owned(),
        })
    });
    results.collect()
}

/// The document with another text in place of a result.
fn replaced(text: &str, result: &Marked, by: &str) -> Result<String> {
    let begin = format!("{BEGIN}{}: {} -->\n", result.name, result.command);
    let at = text.find(&begin).context("a result of this text")? + begin.len();
    let Some(length) = text[at..].find(END) else {
        bail!("{DOCUMENT}: the result {} has no `{END}`", result.name);
    };
    Ok(format!(
        "{}{}\n{}",
        &text[..at],
        by.trim_end(),
        &text[at + length..]
    ))
}

/// Standard output of a command, and its time, s.
fn measured(command: &str) -> Result<(String, f64)> {
    let programs = workspace::target().join("release");
    let path = std::env::var("PATH").unwrap_or_default();
    let mut shell = process::command("bash", &["-o", "pipefail", "-c", command]);
    shell.env("PATH", format!("{}:{path}", programs.display()));
    process::announce(&shell);
    let started = Instant::now();
    let output = shell.stderr(std::process::Stdio::inherit()).output()?;
    ensure!(
        output.status.success(),
        "`{command}` failed: {}",
        output.status
    );
    Ok((
        String::from_utf8(output.stdout)?,
        started.elapsed().as_secs_f64(),
    ))
}

/// Output as Markdown.
fn shown(output: &str) -> String {
    let is_table = output.lines().any(|line| line.starts_with("|--"));
    if is_table {
        output.trim().to_owned()
    } else {
        format!("```text\n{}\n```", output.trim_end())
    }
}

/// Date, commit and processor.
fn machine() -> Result<String> {
    let says = |command: &mut Command| process::output(command).context("date and git are missing");
    let date = says(&mut process::command("date", &["+%Y-%m-%d"]))?;
    let commit = says(&mut process::command(
        "git",
        &["rev-parse", "--short", "HEAD"],
    ))?;
    let processors = fs::read_to_string("/proc/cpuinfo")?;
    let models: Vec<&str> = processors
        .lines()
        .filter(|line| line.starts_with("model name"))
        .filter_map(|line| Some(line.split_once(": ")?.1))
        .collect();
    let model = models.first().unwrap_or(&"unknown processor");
    Ok(format!(
        "{date}, commit {commit}, {} x {model}",
        models.len()
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_result_is_replaced_and_the_text_around_it_stays() {
        let text = format!("# A\n{BEGIN}effects: hitch effects | head -1 -->\nold\n{END}\nafter\n");
        let found = results(&text).expect("well-formed");
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].command, "hitch effects | head -1");
        let new = replaced(&text, &found[0], "new\n").expect("it has an end");
        assert_eq!(new, text.replace("old", "new"));
        assert!(results(&format!("{BEGIN}paper -->")).is_err());
        assert!(replaced(&text.replace(END, ""), &found[0], "new").is_err());
    }

    #[test]
    fn tables_stay_tables_and_other_text_becomes_a_block() {
        assert_eq!(shown("\n| a |\n|---|\n"), "| a |\n|---|");
        assert_eq!(shown("a\n"), "```text\na\n```");
    }
}
