//! Documents: what is cited exists, things are where the table says, and requirements and tests name each other.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use anyhow::{Context, Result, ensure};
use arm_build::workspace;

use crate::sources::FOLDERS;

/// The list of requirements, from the workspace's root.
const REQUIREMENTS: &str = "docs/requirements.md";

/// The page with the table that says where things are, from the workspace's root.
const ARCHITECTURE: &str = "docs/ARCHITECTURE.md";

/// Beginning of a requirement's id. Assembled, so that this file names none.
const ID: &str = concat!("RE", "Q-");

/// Refuses citations of documents that do not exist, requirements that no test shows, and tests that show an unknown one.
pub fn check() -> Result<()> {
    let root = workspace::root();
    let mut texts = BTreeMap::new();
    for folder in FOLDERS.into_iter().chain(["docs"]) {
        for path in workspace::files(&root.join(folder))? {
            let end = path.extension().and_then(|end| end.to_str());
            // Fixtures of faulty files may hold any bytes.
            if matches!(end, Some("rs" | "md" | "toml"))
                && let Ok(text) = fs::read_to_string(&path)
            {
                texts.insert(path, text);
            }
        }
    }
    for entry in fs::read_dir(&root)? {
        let path = entry?.path();
        if path.extension().is_some_and(|end| end == "md") {
            texts.insert(path.clone(), fs::read_to_string(&path)?);
        }
    }
    let mut wrong = Vec::new();
    for (path, text) in &texts {
        let folder = path.parent().unwrap_or(&root);
        let missing = cited(text)
            .into_iter()
            .filter(|name| !root.join(name).exists() && !folder.join(name).exists());
        let place = path.strip_prefix(&root).unwrap_or(path).display();
        wrong.extend(missing.map(|name| format!("{place} cites {name}, which does not exist")));
    }
    let required = texts
        .get(&root.join(REQUIREMENTS))
        .with_context(|| format!("{REQUIREMENTS} is missing"))?;
    let places = texts
        .get(&root.join(ARCHITECTURE))
        .with_context(|| format!("{ARCHITECTURE} is missing"))?;
    wrong.extend(misplaced(places, |file| {
        fs::read_to_string(root.join(file)).ok()
    }));
    let sources = texts
        .iter()
        .filter(|(path, _)| path.extension().is_some_and(|end| end == "rs"))
        .map(|(_, text)| text.as_str());
    wrong.extend(unmatched(required, sources));
    ensure!(wrong.is_empty(), "{}", wrong.join("\n"));
    println!("documents that are cited exist, and every requirement has a test");
    Ok(())
}

/// Names of the Markdown files that a text cites.
fn cited(text: &str) -> BTreeSet<&str> {
    let is_part = |c: char| c.is_ascii_alphanumeric() || "_-./".contains(c);
    text.split(|c| !is_part(c))
        .map(|word| word.trim_end_matches('.'))
        .filter(|word| {
            word.strip_suffix(".md")
                .is_some_and(|stem| !stem.is_empty())
        })
        .collect()
}

/// What does not match between the list of requirements and the comments of tests.
fn unmatched<'a>(required: &'a str, sources: impl Iterator<Item = &'a str>) -> Vec<String> {
    let listed = ids(required);
    let shown: BTreeSet<&str> = sources
        .flat_map(|source| {
            let comments = source.lines().map(str::trim_start);
            let comments = comments.filter(|line| line.starts_with("//"));
            comments.flat_map(ids)
        })
        .collect();
    let untested = listed.difference(&shown);
    let untested = untested.map(|id| format!("{REQUIREMENTS}: no test names {id}"));
    let unknown = shown.difference(&listed);
    let unknown =
        unknown.map(|id| format!("a test names {id}, which {REQUIREMENTS} does not list"));
    untested.chain(unknown).collect()
}

/// Faults of the table of places: a file that does not exist, or does not contain the name. `read` returns its text.
fn misplaced(page: &str, read: impl Fn(&str) -> Option<String>) -> Vec<String> {
    let table = page
        .split("\n## ")
        .find(|part| part.starts_with("Where is"));
    let rows = table.into_iter().flat_map(|part| part.lines());
    let quoted = rows.filter_map(|row| {
        let mut cells = row.split('`').skip(1).step_by(2);
        cells.next().zip(cells.next())
    });
    let wrong = quoted.filter(|(file, name)| !read(file).is_some_and(|text| text.contains(name)));
    wrong
        .map(|(file, name)| format!("{ARCHITECTURE}: there is no {name} in {file}"))
        .collect()
}

/// The requirement ids in a text.
fn ids(text: &str) -> BTreeSet<&str> {
    let is_part = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '-';
    text.split(|c| !is_part(c))
        .filter(|word| word.len() > ID.len() && word.starts_with(ID))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn citations_are_found_with_their_folders() {
        // Assembled, so that this file cites none of them.
        let [page, plain] = ["../docs/a-b", "c"].map(|stem| format!("{stem}.{}", "md"));
        let text = format!("See [the page]({page}#part) and `{plain}`. A .md file, d.markdown.");
        let expected: BTreeSet<&str> = [page.as_str(), plain.as_str()].into();
        assert_eq!(cited(&text), expected);
    }

    #[test]
    fn requirements_without_a_test_and_unknown_ones_are_refused() {
        let [a, b, c] = ["A-1", "A-2", "A-3"].map(|name| format!("{ID}{name}"));
        let listed = format!("| {a} | one |\n| {b} | two |");
        let source = format!("    // {a}, {c}\n    #[test]\n    let text = \"{b}\";");
        let wrong = unmatched(&listed, [source.as_str()].into_iter());
        assert_eq!(wrong.len(), 2, "{wrong:?}");
        assert!(wrong[0].contains(&b) && wrong[1].contains(&c), "{wrong:?}");
        let both = format!("// {a}, {b}");
        assert!(unmatched(&listed, [both.as_str()].into_iter()).is_empty());
    }

    #[test]
    fn a_place_without_its_file_or_name_is_refused() {
        let row = |file: &str, name: &str| format!("| what | `{file}` | `{name}` |\n");
        let rows = [
            row("a.rs", "fn a"),
            row("a.rs", "fn b"),
            row("b.rs", "fn a"),
        ]
        .concat();
        let page = format!(
            "# Page\n\n## Where is ...\n\n| where is | file | name |\n{rows}\n## Next\n{rows}"
        );
        let read = |file: &str| (file == "a.rs").then(|| "fn a() {}".to_owned());
        let wrong = misplaced(&page, read);
        assert_eq!(wrong.len(), 2, "{wrong:?}");
        assert!(
            wrong[0].contains("fn b") && wrong[1].contains("b.rs"),
            "{wrong:?}"
        );
    }

    #[test]
    fn the_documents_are_in_order() {
        check().unwrap();
    }
}
