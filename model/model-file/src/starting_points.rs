//! The two built-in models, as model files.

use hitch_input::source_file::SourceFile;
use hitch_plant::Model;

const NOMINAL: &str = include_str!("../models/nominal.toml");
const DYNAMIC: &str = include_str!("../models/dynamic.toml");

/// The paper's quasi-static model.
#[must_use]
pub fn nominal() -> Model {
    built_in("nominal.toml", NOMINAL)
}

/// The same with dynamics.
#[must_use]
pub fn dynamic() -> Model {
    built_in("dynamic.toml", DYNAMIC)
}

fn built_in(name: &str, text: &str) -> Model {
    let source = SourceFile {
        path: name.into(),
        text: text.to_owned(),
    };
    crate::parse(&source).expect("a shipped model file is sound: its tests read it")
}
