//! An explanation with its model and campaign.

use std::path::PathBuf;

use hitch_identification::adequacy::localization::ErrorProfile;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimate::Estimate;
use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::explain;
use hitch_identification::search::options::Options;
use hitch_identification::suggestion::{Suggestion, suggest};
use hitch_plant::{AddedEffect, Effect, Model, full_name, is_same};

use super::{Explanation, rebuilt};
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::text::{joined, significant};

/// An explanation with its inputs and display form.
#[derive(Debug, Clone)]
pub struct Found {
    /// The initial model.
    pub model: Model,
    /// The prepared campaign.
    pub experiment: Experiment,
    /// The explanation as returned by the identification.
    pub explanation: explain::Explanation,
    /// Where the remaining error is largest, along the first signal that it correlates with.
    pub rest: Option<ErrorProfile>,
    /// A term for the remaining error.
    pub suggestion: Option<Suggestion>,
    /// The display form.
    pub shown: Explanation,
}

impl Found {
    /// Explains a campaign. Reports progress on a terminal, and passes each better result to `improved`.
    pub fn new(
        experiment: Experiment,
        model: Model,
        options: Options<'_>,
        improved: &(dyn Fn(&Estimate) + Sync),
    ) -> Self {
        let progress = Progress::start(format!("explaining {}", experiment.name));
        Self::with_progress(experiment, model, options, improved, &progress)
    }

    /// Explains a campaign, and reports progress to `progress`.
    pub fn with_progress(
        experiment: Experiment,
        model: Model,
        options: Options<'_>,
        improved: &(dyn Fn(&Estimate) + Sync),
        progress: &Progress,
    ) -> Self {
        let better = |fit: &Fit| {
            progress.result(account(&model, fit));
            improved(&fit.estimate);
        };
        let options = Options {
            improved: &better,
            ..options
        };
        let explained = Explained::new(&experiment, &model, options, &|what| {
            progress.say(format!("trying {what}"));
        });
        Self::finished(experiment, model, explained)
    }

    /// An explanation that has been made, with its inputs.
    #[must_use]
    pub fn finished(experiment: Experiment, model: Model, explained: Explained) -> Self {
        let Explained {
            explanation,
            suggestion,
            mut shown,
        } = explained;
        let rest = explanation
            .rest
            .depends_on
            .first()
            .and_then(|signal| ErrorProfile::new(&experiment, &explanation.after, *signal));
        shown.unexplained.whereabouts = rest.as_ref().map(ToString::to_string);
        Self {
            rest,
            suggestion,
            model,
            experiment,
            explanation,
            shown,
        }
    }

    /// The model with the identified effects; a suggested term is defined in it, but not added.
    pub fn rebuilt(&self, name: String) -> Model {
        let mut model = rebuilt(&self.model, &self.explanation.after.estimate, name);
        let defined: Vec<&str> = model.terms.iter().map(|term| term.id()).collect();
        if let Some(suggestion) = &self.suggestion
            && !defined.contains(&suggestion.term.id())
        {
            model.terms.push(suggestion.term);
        }
        model
    }

    /// Writes [`Found::rebuilt`] to a file, if there is one; the file names it.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn write_model(&self, path: Option<&PathBuf>) -> Result<(), Error> {
        let model = |path: &PathBuf| self.rebuilt(hitch_output::stem(path));
        let text = path.map(model).as_ref().map(hitch_model_file::to_toml);
        hitch_output::write_if(path, || text.unwrap_or_default())
    }
}

/// An explanation with a term for the remaining error, as returned by the identification and for display.
#[derive(Debug, Clone)]
pub struct Explained {
    /// As returned by the identification.
    pub explanation: explain::Explanation,
    /// A term for the remaining error.
    pub suggestion: Option<Suggestion>,
    /// The display form.
    pub shown: Explanation,
}

impl Explained {
    /// Explains an experiment; a term is searched for only within the time limit.
    pub fn new(
        experiment: &Experiment,
        model: &Model,
        options: Options<'_>,
        progress: hitch_identification::Progress<'_>,
    ) -> Self {
        let problem = Problem::new(experiment, model);
        let explanation = explain::explain_with(problem, options, progress);
        let suggestion = (!options.is_over()).then(|| {
            suggest(problem.within(options.limit), &explanation, &|what| {
                progress(&format!("a term of its own, {what}"));
            })
        });
        let suggestion = suggestion.flatten();
        let mut shown = Explanation::new(experiment, model, &explanation);
        if let Some(suggestion) = &suggestion {
            shown.unexplained.suggest(suggestion);
        }
        Self {
            explanation,
            suggestion,
            shown,
        }
    }
}

/// A fit in one line: its effects beyond those of the model, and its error.
fn account(model: &Model, fit: &Fit) -> String {
    let unchanged = |added: &AddedEffect| {
        let mut own = model.effects.iter();
        own.any(|own| is_same(own.effect, added.effect) && own.values == added.values)
    };
    let effects = fit
        .estimate
        .effects
        .iter()
        .filter(|added| !unchanged(added));
    let named = |added: &AddedEffect| {
        let unit = added.effect.parameters()[0].unit;
        let size = significant(added.values[0], 3);
        format!("{} {size} {unit}", full_name(added.effect))
            .trim_end()
            .to_owned()
    };
    let effects = effects.map(named);
    format!(
        "best so far: {}; error {:.2} sigma",
        joined(effects, ", "),
        fit.error()
    )
}
