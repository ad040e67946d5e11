//! The option `--model`.

use std::path::PathBuf;

use hitch_plant::Model;

use crate::error::Error;

/// Selects the model of a command.
#[derive(Debug, Clone, clap::Args)]
pub struct ModelArg {
    /// Model: nominal, dynamic, or the name of a model file
    #[arg(long = "model", value_name = "MODEL", default_value = "nominal")]
    name: String,
}

impl ModelArg {
    /// The model file, if a file is named.
    #[must_use]
    pub fn file(&self) -> PathBuf {
        PathBuf::from(&self.name)
    }

    /// The name as given.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The option as written on a command line; empty for the default model.
    #[must_use]
    pub fn written(&self) -> String {
        match self.name.as_str() {
            "nominal" => String::new(),
            name => format!(" --model {name}"),
        }
    }

    /// Reads the model.
    ///
    /// # Errors
    /// If the model does not exist or its file is invalid.
    pub fn load(&self) -> Result<Model, Error> {
        Ok(hitch_model_file::named(&self.name)?)
    }
}
