//! The option `--model`.
use std::path::PathBuf;

use hitch_model::Model;

use crate::error::Error;

/// Which model a command starts from.
#[derive(Debug, Clone, clap::Args)]
pub struct ModelArg {
    /// Model: nominal, dynamic, or the name of a model file
    #[arg(long = "model", value_name = "MODEL", default_value = "nominal")]
    name: String,
}

impl ModelArg {
    /// The file that it would be read from.
    #[must_use]
    pub fn file(&self) -> PathBuf {
        PathBuf::from(&self.name)
    }

    /// Reads the model.
    ///
    /// # Errors
    /// If there is no such model, or its file is wrong.
    pub fn load(&self) -> Result<Model, Error> {
        Ok(Model::named(&self.name)?)
    }
}
