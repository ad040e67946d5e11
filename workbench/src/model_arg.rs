//! The option `--model`.

use std::path::PathBuf;

use hitch_plant::Model;

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

    /// As it is written behind a command: nothing for the model that a command takes anyway.
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
    /// If there is no such model, or its file is wrong.
    pub fn load(&self) -> Result<Model, Error> {
        Ok(hitch_model_file::named(&self.name)?)
    }
}
