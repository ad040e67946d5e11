//! The list of heuristics.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};
use arm_build::workspace;
use toml::de::{DeTable, DeValue};

use super::battery::{Battery, SWITCH};

/// The file with the list, relative to the workspace's root.
const LIST: &str = "xtask/ablations.toml";

/// A heuristic and the source text without it.
#[derive(Debug)]
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

/// Reads the list.
pub fn read() -> Result<Vec<Ablation>> {
    let path = workspace::root().join(LIST);
    let text = fs::read_to_string(&path).with_context(|| LIST.to_owned())?;
    parsed(&text).with_context(|| LIST.to_owned())
}

fn parsed(text: &str) -> Result<Vec<Ablation>> {
    let list = DeTable::parse(text)?.into_inner();
    let entries = list
        .get("ablation")
        .and_then(|list| list.get_ref().as_array());
    let entries = entries.context("there is no [[ablation]]")?;
    entries
        .iter()
        .map(|entry| Ablation::parsed(entry.get_ref()))
        .collect()
}

impl Ablation {
    fn parsed(entry: &DeValue) -> Result<Self> {
        const KEYS: [&str; 6] = ["name", "part", "removes", "file", "find", "replace"];
        let table = entry.as_table().context("[[ablation]] is no table")?;
        let [name, part, removes, file, find, replace] = KEYS.map(|key| {
            let value = table.get(key).and_then(|value| value.get_ref().as_str());
            value
                .map(str::to_owned)
                .ok_or_else(|| anyhow!("an [[ablation]] has no text `{key}`"))
        });
        ensure!(
            table.len() == KEYS.len(),
            "an [[ablation]] has other keys than {}",
            KEYS.join(", ")
        );
        Ok(Self {
            name: name?,
            part: part?.parse()?,
            removes: removes?,
            file: file?,
            find: find?,
            replace: replace?,
        })
    }

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
            "({{ extern crate std; std::env::var(\"{SWITCH}\").is_ok_and(|set| set.split('+').any(|name| name == \"{}\")) }})",
            self.name
        );
        Ok(text.replacen(find, &replace.replace("{off}", &off), 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_entry_has_its_six_texts_and_no_other() {
        let keys = ["name", "removes", "file", "find", "replace"];
        let text: String = keys.map(|key| format!("{key} = \"a\"\n")).concat();
        let text = format!("[[ablation]]\npart = \"control\"\n{text}");
        assert_eq!(parsed(&text).expect("well-formed").len(), 1);
        for wrong in [
            text.replace("file =", "fil ="),
            text.replace("control", "motion"),
            format!("{text}more = 1\n"),
        ] {
            assert!(parsed(&wrong).is_err(), "{wrong}");
        }
    }

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
