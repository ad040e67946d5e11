//! No circle of files inside a crate: what a file uses, and what that uses, never leads back to it.
//!
//! The paths of the sources are followed to the file that defines what they name, through re-exports. A re-export is no use:
//! a front page may name everything below it. Tests are exempt.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use arm_build::workspace;
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ExprLit, Item, ItemMod, Lit, Meta, Token, UseTree, Visibility};

/// The folders that hold crates, from the workspace's root.
const FOLDERS: [&str; 5] = ["firmware", "host-tests", "model", "workbench", "xtask"];

/// The names of the modules that lead to one, from the root of its crate; or of a path.
type Names = Vec<String>;

/// What a file defines and uses.
#[derive(Default)]
struct Source {
    defined: BTreeSet<String>,
    /// The path of each name that a `use` brings into the file.
    imported: BTreeMap<String, Names>,
    /// Modules of which a `use` brings in everything.
    globs: Vec<Names>,
    /// Paths that the file uses.
    used: BTreeSet<Names>,
}

/// What a file takes from another.
#[derive(Clone, Copy)]
struct Use<'a> {
    by: &'a Names,
    file: &'a Names,
    name: &'a str,
}

/// The files of a crate by their modules.
struct Sources(BTreeMap<Names, Source>);

/// Rejects circles of files.
pub fn check() -> Result<()> {
    let mut wrong = Vec::new();
    let mut files = 0;
    for root in roots()? {
        let sources = Sources::read(&root)?;
        files += sources.0.len();
        wrong.extend(sources.circles().iter().map(|circle| {
            let root = root.strip_prefix(workspace::root()).unwrap_or(&root);
            format!("{}: {}", root.display(), written(circle))
        }));
    }
    ensure!(
        wrong.is_empty(),
        "circles of files; move what ties them to a file below:\n{}",
        wrong.join("\n")
    );
    println!("no circle among {files} files of sources");
    Ok(())
}

/// The folder of each crate's sources; a program of several files in `bin` is a crate of its own.
fn roots() -> Result<Vec<PathBuf>> {
    let mut roots = BTreeSet::new();
    for folder in FOLDERS {
        for file in workspace::files(&workspace::root().join(folder))? {
            let is_root = file
                .file_name()
                .is_some_and(|name| name == "lib.rs" || name == "main.rs");
            let sources = |at: &Path| {
                at.ends_with("src") || at.parent().is_some_and(|up| up.ends_with("src/bin"))
            };
            if let Some(parent) = file.parent().filter(|at| is_root && sources(at)) {
                roots.insert(parent.to_path_buf());
            }
        }
    }
    Ok(roots.into_iter().collect())
}

impl Sources {
    fn read(root: &Path) -> Result<Self> {
        let mut sources = BTreeMap::new();
        for file in workspace::files(root)? {
            let place = file.strip_prefix(root)?;
            if file.extension().is_none_or(|end| end != "rs") || place.starts_with("bin") {
                continue;
            }
            let text = fs::read_to_string(&file)?;
            let parsed = Source::parsed(&text).with_context(|| file.display().to_string())?;
            sources.insert(module_of(place), parsed);
        }
        Ok(Self(sources))
    }

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
                if self.0.contains_key(&below(from, name)) {
                    at.push(name.to_owned());
                } else {
                    let start = self.0.get(from)?.imported.get(name)?;
                    return self.definer(from, &[start, rest].concat(), depth.checked_sub(1)?);
                }
            }
        }
        while let Some((name, further)) = rest.split_first() {
            let next = below(&at, name);
            if name == "super" {
                at.pop();
            } else if self.0.contains_key(&next) {
                at = next;
            } else {
                let source = self.0.get(&at)?;
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
            .0
            .iter()
            .map(|(module, source)| {
                let used = source.used.iter();
                let files = used.filter_map(|path| {
                    let file = self.definer(module, path, 8)?;
                    let (file, _) = self
                        .0
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
        let ways = self.0.keys().filter_map(|module| way_back(module, &uses));
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

/// The module of a file below the root of its crate.
fn module_of(place: &Path) -> Names {
    let mut module: Names = place
        .with_extension("")
        .iter()
        .map(|part| part.to_string_lossy().into_owned())
        .collect();
    if module
        .last()
        .is_some_and(|last| ["lib", "main", "mod"].contains(&last.as_str()))
    {
        module.pop();
    }
    module
}

fn below(module: &[String], name: &str) -> Names {
    module.iter().cloned().chain([name.to_owned()]).collect()
}

impl Source {
    fn parsed(text: &str) -> syn::Result<Self> {
        let mut source = Self::default();
        source.visit_file(&syn::parse_file(text)?);
        Ok(source)
    }

    /// Takes in what a `use` names, below a path.
    fn import(&mut self, tree: &UseTree, path: &mut Names, is_public: bool) {
        let named = |source: &mut Self, end: &str, name: String| {
            let whole = match end {
                "self" => path.clone(),
                _ => below(path, end),
            };
            if !is_public {
                source.used.insert(whole.clone());
            }
            source.imported.insert(name, whole);
        };
        match tree {
            UseTree::Path(inner) => {
                path.push(inner.ident.to_string());
                self.import(&inner.tree, path, is_public);
                path.pop();
            }
            UseTree::Name(end) if end.ident == "self" => {
                named(self, "self", path.last().cloned().unwrap_or_default());
            }
            UseTree::Name(end) => named(self, &end.ident.to_string(), end.ident.to_string()),
            UseTree::Rename(end) => named(self, &end.ident.to_string(), end.rename.to_string()),
            UseTree::Glob(_) => self.globs.push(path.clone()),
            UseTree::Group(group) => {
                for item in &group.items {
                    self.import(item, path, is_public);
                }
            }
        }
    }
}

impl<'ast> Visit<'ast> for Source {
    fn visit_item(&mut self, item: &'ast Item) {
        let (attributes, name): (&[Attribute], _) = match item {
            Item::Const(item) => (&item.attrs, Some(&item.ident)),
            Item::Enum(item) => (&item.attrs, Some(&item.ident)),
            Item::Fn(item) => (&item.attrs, Some(&item.sig.ident)),
            Item::Macro(item) => (&item.attrs, item.ident.as_ref()),
            Item::Static(item) => (&item.attrs, Some(&item.ident)),
            Item::Struct(item) => (&item.attrs, Some(&item.ident)),
            Item::Trait(item) => (&item.attrs, Some(&item.ident)),
            Item::Type(item) => (&item.attrs, Some(&item.ident)),
            Item::Impl(item) => (&item.attrs, None),
            Item::Use(item) => (&item.attrs, None),
            Item::Mod(item) => (&item.attrs, item.content.as_ref().map(|_| &item.ident)),
            _ => (&[], None),
        };
        if attributes.iter().any(is_of_tests) {
            return;
        }
        self.defined.extend(name.map(ToString::to_string));
        if let Item::Mod(module) = item {
            self.imported.extend(elsewhere(module));
        }
        if let Item::Use(item) = item {
            let is_public = !matches!(item.vis, Visibility::Inherited);
            self.import(&item.tree, &mut Vec::new(), is_public);
        } else {
            visit::visit_item(self, item);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if path.leading_colon.is_none() && path.segments.len() > 1 {
            let names = path.segments.iter().map(|part| part.ident.to_string());
            self.used.insert(names.collect());
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        let arguments = Punctuated::<Expr, Token![,]>::parse_terminated;
        for argument in call.parse_body_with(arguments).into_iter().flatten() {
            Visit::visit_expr(self, &argument);
        }
    }
}

/// A module that lies elsewhere: `#[path = "there/mod.rs"]`.
fn elsewhere(module: &ItemMod) -> Option<(String, Names)> {
    let written = module
        .attrs
        .iter()
        .find_map(|attribute| match &attribute.meta {
            Meta::NameValue(pair) if pair.path.is_ident("path") => Some(&pair.value),
            _ => None,
        })?;
    let Expr::Lit(ExprLit {
        lit: Lit::Str(place),
        ..
    }) = written
    else {
        return None;
    };
    let names = module_of(Path::new(&place.value()));
    Some((
        module.ident.to_string(),
        [vec!["self".to_owned()], names].concat(),
    ))
}

fn is_of_tests(attribute: &Attribute) -> bool {
    attribute.path().is_ident("cfg")
        && attribute
            .parse_args::<syn::Ident>()
            .is_ok_and(|word| word == "test")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circles(files: &[(&str, &str)]) -> Vec<String> {
        let parsed = |&(place, text): &(&str, &str)| {
            (module_of(Path::new(place)), Source::parsed(text).unwrap())
        };
        let sources = Sources(files.iter().map(parsed).collect());
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
        check().unwrap();
    }
}
