//! No circle of files inside a crate: what a file uses, and what that uses, never leads back to it.
//!
//! The paths of the sources are followed to the file that defines what they name, through re-exports. A re-export is no use:
//! a front page may name everything below it. Tests are exempt.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Result, ensure};

use crate::sources::{Crate, Names, below};

/// Number of re-exports in a row that are followed; more than the workspace has.
const RE_EXPORTS: usize = 8;

/// What a file takes from another.
#[derive(Clone, Copy)]
struct Use<'a> {
    by: &'a Names,
    file: &'a Names,
    name: &'a str,
}

/// Rejects circles of files.
pub fn check(crates: &[Crate]) -> Result<()> {
    let wrong = crates.iter().flat_map(|one| {
        let circles = one.circles();
        let lines = circles
            .iter()
            .map(|circle| format!("{}: {}", one.folder, written(circle)));
        lines.collect::<Vec<_>>()
    });
    let wrong: Vec<String> = wrong.collect();
    ensure!(
        wrong.is_empty(),
        "circles of files; move what ties them to a file below:\n{}",
        wrong.join("\n")
    );
    let files: usize = crates.iter().map(|one| one.files.len()).sum();
    println!("no circle among {files} files of sources");
    Ok(())
}

impl Crate {
    /// The module whose file defines what a path names, as seen from a module; `None` outside the crate.
    fn definer(&self, from: &Names, path: &[String], depth: usize) -> Option<Names> {
        let (first, mut rest) = path.split_first()?;
        let mut at = from.clone();
        match first.as_str() {
            "crate" => at.clear(),
            "self" => {}
            "super" => {
                at.pop();
            }
            name => {
                if self.files.contains_key(&below(from, name)) {
                    at.push(name.to_owned());
                } else {
                    let start = self.files.get(from)?.imported.get(name)?;
                    return self.definer(from, &[start, rest].concat(), depth.checked_sub(1)?);
                }
            }
        }
        while let Some((name, further)) = rest.split_first() {
            let next = below(&at, name);
            if name == "super" {
                at.pop();
            } else if self.files.contains_key(&next) {
                at = next;
            } else {
                let source = self.files.get(&at)?;
                if source.defined.contains(name) {
                    return Some(at);
                }
                let deeper = depth.checked_sub(1)?;
                if let Some(start) = source.imported.get(name) {
                    return self.definer(&at, &[start, further].concat(), deeper);
                }
                return source
                    .globs
                    .iter()
                    .find_map(|glob| self.definer(&at, &[glob, rest].concat(), deeper))
                    .or(Some(at.clone()));
            }
            rest = further;
        }
        // The path of a module alone uses nothing of it.
        None
    }

    /// For each file on a circle the shortest way back to it; each set of files once.
    fn circles(&self) -> Vec<Vec<Use<'_>>> {
        let uses: BTreeMap<&Names, Vec<Use<'_>>> = self
            .files
            .iter()
            .map(|(module, source)| {
                let used = source.used.iter();
                let files = used.filter_map(|path| {
                    let file = self.definer(module, path, RE_EXPORTS)?;
                    let (file, _) = self
                        .files
                        .get_key_value(&file)
                        .filter(|(file, _)| *file != module)?;
                    Some(Use {
                        by: module,
                        file,
                        name: path.last()?,
                    })
                });
                (module, files.collect())
            })
            .collect();
        let mut seen = BTreeSet::new();
        let ways = self
            .files
            .keys()
            .filter_map(|module| way_back(module, &uses));
        ways.filter(|circle| {
            seen.insert(circle.iter().map(|used| used.by).collect::<BTreeSet<_>>())
        })
        .collect()
    }
}

/// The shortest way from a file over those that it uses back to it.
fn way_back<'a>(
    start: &'a Names,
    uses: &BTreeMap<&'a Names, Vec<Use<'a>>>,
) -> Option<Vec<Use<'a>>> {
    let mut before: BTreeMap<&Names, Use<'a>> = BTreeMap::new();
    let mut edge = vec![start];
    while !edge.is_empty() && !before.contains_key(start) {
        let mut further = Vec::new();
        for used in edge.iter().filter_map(|from| uses.get(from)).flatten() {
            before.entry(used.file).or_insert_with(|| {
                further.push(used.file);
                *used
            });
        }
        edge = further;
    }
    let mut way = vec![*before.get(start)?];
    while let Some(used) = way.last().filter(|used| used.by != start) {
        way.push(*before.get(used.by)?);
    }
    way.reverse();
    Some(way)
}

/// A circle in words: each file, and the name that it takes from the next.
fn written(circle: &[Use<'_>]) -> String {
    let module = |names: &Names| {
        if names.is_empty() {
            "the front page".to_owned()
        } else {
            names.join("::")
        }
    };
    let uses = circle
        .iter()
        .map(|used| format!("{} takes {} from ", module(used.by), used.name));
    uses.chain(circle.first().map(|used| module(used.by)))
        .collect()
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::sources::{Source, crates, module_of};

    fn circles(files: &[(&str, &str)]) -> Vec<String> {
        let parsed = |&(place, text): &(&str, &str)| {
            (module_of(Path::new(place)), Source::parsed(text).unwrap())
        };
        let sources = Crate {
            folder: String::new(),
            files: files.iter().map(parsed).collect(),
        };
        let files = |circle: &Vec<Use<'_>>| {
            circle
                .iter()
                .map(|used| used.by.join("::"))
                .collect::<Vec<_>>()
                .join(" ")
        };
        sources.circles().iter().map(files).collect()
    }

    #[test]
    fn two_files_that_use_each_other_are_a_circle_however_it_is_written() {
        let a = "pub struct A; fn f() { let b = super::b::make(); }";
        for b in [
            "use super::a::A; pub fn make() -> A { A }",
            "use crate::{a::{A}, c}; pub fn make() {}",
            "pub fn make() { println!(\"{:?}\", crate::a::A); }",
            "use crate::a; pub fn make() -> a::A { a::A }",
            "pub fn make() { let a = crate::A; }",
        ] {
            let files = [
                ("a.rs", a),
                ("b.rs", b),
                ("c.rs", ""),
                ("lib.rs", "mod a; mod b; pub use a::A;"),
            ];
            assert_eq!(circles(&files), ["a b"], "{b}");
        }
    }

    #[test]
    fn a_front_page_may_name_what_uses_it_only_as_a_re_export() {
        let child = ("m/child.rs", "use super::Base; pub struct Child(Base);");
        assert!(
            circles(&[
                (
                    "m/mod.rs",
                    "mod child; pub use child::Child; pub struct Base;"
                ),
                child
            ])
            .is_empty()
        );
        let user = (
            "m/mod.rs",
            "mod child; pub struct Base; fn f() -> child::Child { todo!() }",
        );
        assert_eq!(circles(&[user, child]), ["m m::child"]);
    }

    #[test]
    fn a_long_way_back_is_a_circle_and_tests_are_exempt() {
        let on = |next: &str| format!("use crate::{next}::X as Y; pub struct X(Y);");
        let [a, b, c] = ["b", "c", "a"].map(on);
        assert_eq!(
            circles(&[("a.rs", &a), ("b.rs", &b), ("c.rs", &c)]),
            ["a b c"]
        );
        let exempt = "pub struct X; #[cfg(test)] mod tests { use crate::a::X; } #[cfg(test)] fn f() -> crate::a::X { todo!() }";
        assert!(circles(&[("a.rs", &a), ("b.rs", &b), ("c.rs", exempt)]).is_empty());
    }

    #[test]
    fn no_crate_has_a_circle_of_files() {
        check(&crates().unwrap()).unwrap();
    }
}
