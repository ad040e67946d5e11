//! The option `--model`.

use std::path::PathBuf;

use hitch_campaign::Campaign;
use hitch_identification::explanation::starting_point::StartingPoint;
use hitch_plant::{Dynamics, Model};

use hitch_output::error::Error;
use hitch_output::text::shell_word;

/// The model without the option, and the same with dynamics.
const NOMINAL: &str = "nominal";
const DYNAMIC: &str = "dynamic";

/// Selects the model of a command.
#[derive(Debug, Clone, clap::Args)]
pub struct ModelArg {
    /// Model: nominal, dynamic, or the name of a model file; nominal if not given, and for a search the nearer of both
    #[arg(long = "model", value_name = "MODEL")]
    name: Option<String>,
}

impl ModelArg {
    /// The model file, if a file is named.
    #[must_use]
    pub fn file(&self) -> PathBuf {
        PathBuf::from(self.name())
    }

    /// The name as given.
    #[must_use]
    pub fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(NOMINAL)
    }

    /// The name as one word of a command line.
    #[must_use]
    pub fn word(&self) -> String {
        shell_word(self.name().as_ref())
    }

    /// The option as written on a command line; empty for the default model.
    #[must_use]
    pub fn written(&self) -> String {
        match &self.name {
            None => String::new(),
            Some(_) => format!(" --model {}", self.word()),
        }
    }

    /// Reads the model.
    ///
    /// # Errors
    /// If the model does not exist or its file is invalid.
    pub fn load(&self) -> Result<Model, Error> {
        Ok(hitch_model_file::named(self.name())?)
    }

    /// The model to search a campaign with. A model without effects, as of a data sheet, gets the form that is nearer to the
    /// campaign: statics or dynamics. A note states it. Any other model in the wrong form gets a warning.
    #[must_use]
    pub fn nearer(&self, model: Model, campaign: &Campaign) -> Model {
        let start = StartingPoint::new(campaign, &model, self.other_form(&model));
        if !start.is_wrong() {
            return model;
        }
        let form = |model: &Model| match model.constants().dynamics {
            Dynamics::Steady => "without dynamics (steady)",
            Dynamics::Dynamic => "with dynamics",
        };
        let errors = format!(
            "after switching, {} has an error of {:.2} sigma {}, and of {:.2} {}",
            campaign.name,
            start.error_of_other,
            form(&start.other),
            start.declared,
            form(&model)
        );
        let is_named = self.name.as_deref().is_some_and(is_built_in);
        if is_named || !model.effects.is_empty() {
            eprintln!("warning: wrong form of the model: {errors}; results may mean nothing");
            return model;
        }
        eprintln!("note: the model is taken {}: {errors}", form(&start.other));
        start.other
    }

    /// The model with dynamics if it has none, or without. A built-in one has its other form built in.
    fn other_form(&self, model: &Model) -> Model {
        let dynamics = match model.constants().dynamics {
            Dynamics::Steady => Dynamics::Dynamic,
            Dynamics::Dynamic => Dynamics::Steady,
        };
        match dynamics {
            _ if !is_built_in(self.name()) => model.with_dynamics(dynamics),
            Dynamics::Steady => hitch_model_file::nominal(),
            Dynamics::Dynamic => hitch_model_file::dynamic(),
        }
    }
}

fn is_built_in(name: &str) -> bool {
    [NOMINAL, DYNAMIC].contains(&name)
}
