//! The list of heuristics.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, bail};
use arm_build::workspace;
use serde::Deserialize;

use super::SWITCH;
use super::battery::Battery;

/// The file with the list, relative to the workspace's root.
const LIST: &str = "xtask/ablations.toml";

/// A heuristic and the source text without it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ablation {
    /// Name for the command line.
    pub name: String,
    /// The part it belongs to, which decides on the benchmark.
    pub part: Battery,
    /// What is removed, for the table.
    pub removes: String,
    /// The source file, relative to the workspace's root.
    pub file: String,
    /// Text that occurs once in the file.
    find: String,
    /// The text in its place. `{off}` stands for an expression that is true if the heuristic is removed.
    replace: String,
}

#[derive(Deserialize)]
struct List {
    ablation: Vec<Ablation>,
}

/// Reads the list.
pub fn read() -> Result<Vec<Ablation>> {
    let path = workspace::root().join(LIST);
    let text = fs::read_to_string(&path).with_context(|| LIST.to_owned())?;
    let list: List = toml::from_str(&text).with_context(|| LIST.to_owned())?;
    Ok(list.ablation)
}

impl Ablation {
    /// Checks that the entry matches the source below `root`.
    pub fn check(&self, root: &Path) -> Result<()> {
        let path = root.join(&self.file);
        let text = fs::read_to_string(&path).with_context(|| format!("{LIST}: {}", self.file))?;
        self.applied_to(&text).map(drop)
    }

    /// The text of its file with the heuristic behind its switch.
    pub fn applied_to(&self, text: &str) -> Result<String> {
        let (find, replace) = (self.find.trim(), self.replace.trim());
        let found = text.matches(find).count();
        if found != 1 {
            bail!(
                "{LIST}: the text of {} occurs {found} times in {}, not once; adapt the entry to the source",
                self.name,
                self.file
            );
        }
        let off = format!(
            "({{ extern crate std; std::env::var_os(\"{SWITCH}\").is_some_and(|name| name == \"{}\") }})",
            self.name
        );
        Ok(text.replacen(find, &replace.replace("{off}", &off), 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_replaces_its_text_and_one_that_does_not_match_is_refused() {
        let ablation = Ablation {
            name: "late".to_owned(),
            part: Battery::Control,
            removes: "the delay".to_owned(),
            file: "a.rs".to_owned(),
            find: "\nlet a = delay();\n".to_owned(),
            replace: "let a = if {off} { 0 } else { delay() };".to_owned(),
        };
        let replaced = ablation.applied_to("fn f() {\n    let a = delay();\n}\n");
        let replaced = replaced.expect("the text is there");
        assert!(replaced.contains("HITCH_ABLATION"), "{replaced}");
        assert!(
            replaced.starts_with("fn f() {\n    let a = if ({"),
            "{replaced}"
        );
        assert!(
            ablation
                .applied_to("let a = delay(); let a = delay();")
                .is_err()
        );
        assert!(ablation.applied_to("").is_err());
    }
}
