//! The two starting points that come with the project: model files like any other, built in.
use crate::input_error::InputError;
use crate::model::Model;
use crate::source_file::SourceFile;

const NOMINAL: &str = include_str!("../models/nominal.toml");
const DYNAMIC: &str = include_str!("../models/dynamic.toml");

impl Model {
    /// The paper's quasi-static model.
    #[must_use]
    pub fn nominal() -> Self {
        built_in("nominal.toml", NOMINAL)
    }

    /// The same with known dynamics.
    #[must_use]
    pub fn dynamic() -> Self {
        built_in("dynamic.toml", DYNAMIC)
    }
}

fn built_in(name: &str, text: &str) -> Model {
    let source = SourceFile {
        path: name.into(),
        text: text.to_owned(),
    };
    let model: Result<Model, InputError> = Model::from_source(&source);
    model.expect("a shipped model file is sound: its tests read it")
}
