//! The two built-in models, as model files.

use hitch_input::source_file::SourceFile;
use hitch_plant::Model;

use crate::read;

const NOMINAL: &str = include_str!("../models/nominal.toml");
const DYNAMIC: &str = include_str!("../models/dynamic.toml");

/// The paper's quasi-static model.
#[must_use]
pub fn nominal() -> Model {
    built_in("nominal.toml", NOMINAL, |_| None)
}

/// The same with dynamics.
#[must_use]
pub fn dynamic() -> Model {
    built_in("dynamic.toml", DYNAMIC, |name| {
        (name == "nominal").then(nominal)
    })
}

fn built_in(name: &str, text: &str, base: impl Fn(&str) -> Option<Model>) -> Model {
    let source = SourceFile {
        path: name.into(),
        text: text.to_owned(),
    };
    read::model(&source, base).expect("a shipped model file is sound: its tests read it")
}

/// A starting point by its name.
pub fn starting_point(name: &str) -> Option<Model> {
    match name {
        "nominal" => Some(nominal()),
        "dynamic" => Some(dynamic()),
        _ => None,
    }
}
