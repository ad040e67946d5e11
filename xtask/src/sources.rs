//! What the files of each crate define and use, by the paths in their sources.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use arm_build::workspace;
use syn::punctuated::Punctuated;
use syn::visit::{self, Visit};
use syn::{Attribute, Expr, ExprLit, Item, ItemMod, Lit, Meta, Token, UseTree, Visibility};

/// The names of the modules that lead to one, from the root of its crate; or of a path.
pub type Names = Vec<String>;

/// The folders that hold crates, from the workspace's root.
pub const FOLDERS: [&str; 5] = ["firmware", "host-tests", "model", "workbench", "xtask"];

/// The files of a crate.
pub struct Crate {
    /// Folder of its sources, from the workspace's root.
    pub folder: String,
    /// The files by their modules.
    pub files: BTreeMap<Names, Source>,
}

/// What a file defines and uses.
#[derive(Default)]
pub struct Source {
    pub defined: BTreeSet<String>,
    /// The path of each name that a `use` brings into the file.
    pub imported: BTreeMap<String, Names>,
    /// Modules of which a `use` brings in everything.
    pub globs: Vec<Names>,
    /// Paths that the file uses.
    pub used: BTreeSet<Names>,
}

/// All crates of the workspace.
///
/// # Errors
/// A file can't be read, or is no Rust.
pub fn crates() -> Result<Vec<Crate>> {
    roots()?.iter().map(|root| Crate::read(root)).collect()
}

/// The folder of each crate's sources; a program of several files in `bin` is a crate of its own.
fn roots() -> Result<BTreeSet<PathBuf>> {
    let mut roots = BTreeSet::new();
    for folder in FOLDERS {
        for file in workspace::files(&workspace::root().join(folder))? {
            let is_root = file.ends_with("lib.rs") || file.ends_with("main.rs");
            let sources = |at: &Path| {
                at.ends_with("src") || at.parent().is_some_and(|up| up.ends_with("src/bin"))
            };
            if let Some(parent) = file.parent().filter(|at| is_root && sources(at)) {
                roots.insert(parent.to_path_buf());
            }
        }
    }
    Ok(roots)
}

impl Crate {
    fn read(root: &Path) -> Result<Self> {
        let mut files = BTreeMap::new();
        for file in workspace::files(root)? {
            let place = file.strip_prefix(root)?;
            if file.extension().is_none_or(|end| end != "rs") || place.starts_with("bin") {
                continue;
            }
            let text = fs::read_to_string(&file)?;
            let parsed = Source::parsed(&text).with_context(|| file.display().to_string())?;
            files.insert(module_of(place), parsed);
        }
        let folder = root.strip_prefix(workspace::root()).unwrap_or(root);
        let folder = folder.display().to_string();
        Ok(Self { folder, files })
    }
}

/// The module of a file below the root of its crate.
pub fn module_of(place: &Path) -> Names {
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

pub fn below(module: &[String], name: &str) -> Names {
    module.iter().cloned().chain([name.to_owned()]).collect()
}

impl Source {
    /// What the text of a file defines and uses, without its tests.
    ///
    /// # Errors
    /// It is no Rust.
    pub fn parsed(text: &str) -> syn::Result<Self> {
        let mut source = Self::default();
        source.visit_file(&syn::parse_file(text)?);
        Ok(source)
    }

    /// Every path in the file, those of re-exports too.
    pub fn paths(&self) -> impl Iterator<Item = &Names> {
        self.used
            .iter()
            .chain(self.imported.values())
            .chain(&self.globs)
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
