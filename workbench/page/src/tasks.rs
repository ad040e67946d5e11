//! Computations of a session: rank effects, fit a model, explain the campaign.

mod run;

use std::ops::RangeInclusive;
use std::sync::Arc;

use hitch_identification::constants::tolerances::Tolerances;
use hitch_identification::estimate::Estimate;
use hitch_identification::suggestion::Suggestion;
use hitch_plant::{Effect, Model, full_name};
use serde::Deserialize;

use super::own_term::TermForm;
use super::parameters::{held, moved};
use super::refusal::Refusal;
use super::second::Second;
use super::session::{Explained, Ranking, Session, Step};
use super::source::Subject;
use super::tuned::TunedFor;
use hitch_output::error::Error;
use hitch_results::arguments::effect::find;
use hitch_results::arguments::known_constants::KnownConstants;
use hitch_results::arguments::search::BUDGET_S;

/// Times of an explanation, s.
const BUDGETS_S: RangeInclusive<f64> = 1.0..=86_400.0;

/// Numbers of candidates of a tuned calibration.
const TRIALS: RangeInclusive<usize> = 10..=100_000;

/// A computation as requested by a tab.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "task", rename_all = "lowercase")]
pub enum Task {
    /// Evaluate every effect that the model lacks.
    Rank,
    /// Add an effect and fit.
    Add {
        /// Its name, with its form.
        effect: String,
    },
    /// Add a user-defined term and fit.
    Term {
        /// Its definition.
        term: TermForm,
    },
    /// Remove an effect and fit.
    Remove {
        /// Index of the effect.
        effect: usize,
    },
    /// Set a parameter of an effect manually.
    Set {
        /// Index of the effect.
        effect: usize,
        /// Index of the parameter.
        parameter: usize,
        /// Its value, in its unit.
        value: f64,
    },
    /// Fix a parameter of an effect in later fits, or free it.
    Fix {
        /// Index of the effect.
        effect: usize,
        /// Index of the parameter.
        parameter: usize,
        /// Whether it is fixed.
        fixed: bool,
    },
    /// Fit all effects from their present values.
    Fit,
    /// Find all missing effects.
    Explain(Search),
    /// Fit the constants of the present model, which becomes the first model.
    Constants {
        /// What is known of them.
        known: KnownConstants,
    },
    /// Tune the calibration of the present model.
    Tune {
        /// Number of candidates.
        trials: usize,
    },
    /// Accept steps of the explanation.
    Adopt {
        /// Indices of the accepted steps.
        steps: Vec<usize>,
    },
    /// Accept the explanation together with its suggested term.
    Suggested,
    /// Evaluate a second model; not requested by this name, but with a file.
    #[serde(skip)]
    Second {
        /// Name of its file.
        title: String,
        /// The model.
        model: Box<Model>,
    },
}

/// How an explanation is searched.
#[derive(Debug, Clone, Deserialize)]
#[serde(default)]
pub struct Search {
    /// Time after which it ends with its best so far, s.
    budget_s: f64,
    /// Whether the constants come from data sheets and are fitted together with the effects.
    data_sheet: bool,
    /// What is known of constants that are fitted.
    known: KnownConstants,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            budget_s: BUDGET_S,
            data_sheet: false,
            known: KnownConstants::default(),
        }
    }
}

/// A task with its inputs.
pub struct Ready {
    subject: Arc<Subject>,
    model: Model,
    /// The present model with its effects.
    rebuilt: Model,
    present: Step,
    ranking: Option<Arc<Ranking>>,
    what: What,
}

/// Where a fit of constants starts.
struct Start {
    /// The model.
    model: Box<Model>,
    /// Tolerances of its constants.
    tolerances: Tolerances,
}

/// A checked task.
enum What {
    Rank,
    Explain(Search, Start),
    Constants(Start),
    Tune(usize),
    Add(&'static dyn Effect),
    Remove(usize),
    Set(Estimate, String),
    Fix(Estimate, String),
    Fit,
    Adopt(Arc<Explained>, Vec<usize>),
    Suggested(Suggestion),
    Second(String, Box<Model>),
}

/// Result of a task.
pub enum Outcome {
    /// A ranking.
    Ranking(Arc<Ranking>),
    /// An explanation.
    Explained(Arc<Explained>),
    /// Steps of the session.
    Steps(Vec<Step>),
    /// A second model.
    Second(Arc<Second>),
    /// Another first model.
    First(Arc<Subject>),
    /// A tuned calibration.
    Tuned(Arc<TunedFor>),
    /// Nothing, for this reason.
    Failed(String),
}

impl Outcome {
    /// Stores the result in the session.
    pub fn apply(self, session: &mut Session) {
        match self {
            Self::Ranking(ranking) => session.ranking = Some(ranking),
            Self::Explained(explained) => session.explained = Some(explained),
            Self::Steps(steps) => steps.into_iter().for_each(|step| session.push(step)),
            Self::Second(second) => session.second = Some(second),
            Self::First(subject) => session.exchange(subject),
            Self::Tuned(tuned) => session.tuned = Some(tuned),
            Self::Failed(_) => {}
        }
    }
}

impl Ready {
    /// Checks a task against a session.
    ///
    /// # Errors
    /// If the session does not have what the task refers to.
    pub fn new(session: &Session, task: Task) -> Result<Self, Refusal> {
        let effects = &session.fit().estimate.effects;
        let there = |effect: usize| {
            let added = effects.get(effect);
            added.ok_or_else(|| Refusal::conflict("the effect is no longer in the model"))
        };
        let unknown = || Refusal::conflict("the effect does not have this parameter");
        let mut present = session.present().clone();
        let what = match task {
            Task::Rank => What::Rank,
            Task::Explain(search) => {
                check_search(&search)?;
                let present = session.fit().estimate.applied_to(&session.model());
                let start = if search.data_sheet {
                    Start::new(&search.known, present)?
                } else {
                    Start::new(&KnownConstants::default(), present)?
                };
                What::Explain(search, start)
            }
            Task::Constants { known } => What::Constants(Start::new(&known, session.rebuilt())?),
            Task::Tune { trials } if TRIALS.contains(&trials) => What::Tune(trials),
            Task::Tune { .. } => {
                let (low, high) = (TRIALS.start(), TRIALS.end());
                let what = format!("the number of candidates is {low} to {high}");
                return Err(Refusal::wrong(what));
            }
            Task::Fit => What::Fit,
            Task::Add { effect } => What::Add(new_effect(session, &effect)?),
            Task::Term { term } => {
                let term = term.define().map_err(Refusal::wrong)?;
                present.define(term);
                What::Add(lacking(session, term)?)
            }
            Task::Remove { effect } => there(effect).map(|_| What::Remove(effect))?,
            Task::Set {
                effect,
                parameter,
                value,
            } => {
                let title = format!("{} set by hand", full_name(there(effect)?.effect));
                let estimate = moved(&session.fit().estimate, effect, parameter, value);
                What::Set(estimate.ok_or_else(unknown)?, title)
            }
            Task::Fix {
                effect,
                parameter,
                fixed,
            } => {
                let estimate = &session.fit().estimate;
                let (estimate, title) =
                    held(estimate, there(effect)?.effect, parameter, fixed).ok_or_else(unknown)?;
                What::Fix(estimate, title)
            }
            Task::Second { title, model } => What::Second(title, model),
            Task::Adopt { steps } => What::Adopt(present_explanation(session)?, steps),
            Task::Suggested => {
                let suggestion = present_explanation(session)?.found.suggestion.clone();
                let none = || Refusal::conflict("the explanation suggests no term");
                let suggestion = suggestion.ok_or_else(none)?;
                present.define(suggestion.term);
                What::Suggested(suggestion)
            }
        };
        Ok(Self {
            subject: Arc::clone(session.subject()),
            model: session.model().with_terms(present.terms.clone()),
            rebuilt: session.rebuilt(),
            present,
            ranking: session.present_ranking().cloned(),
            what,
        })
    }

    /// Description of the computation, for the page.
    pub fn title(&self) -> String {
        match &self.what {
            What::Rank => "Evaluating every effect".to_owned(),
            What::Explain(..) => "Explaining".to_owned(),
            What::Constants(_) => "Fitting the constants".to_owned(),
            What::Tune(_) => "Tuning the calibration".to_owned(),
            What::Add(effect) => format!("Adding {}", full_name(*effect)),
            What::Remove(effect) => format!("Taking {} away", self.name(*effect)),
            What::Set(_, _) => "Evaluating all runs".to_owned(),
            What::Fix(_, title) => title.clone(),
            What::Fit => "Fitting all effects".to_owned(),
            What::Adopt(..) => "Accepting the steps".to_owned(),
            What::Suggested(found) => format!("Adding {}", found.term.id()),
            What::Second(title, _) => format!("Evaluating {title}"),
        }
    }

    /// Whether it ends with its best result so far when it is cancelled.
    pub fn keeps_best(&self) -> bool {
        matches!(self.what, What::Explain(..) | What::Tune(_))
    }
}

impl Start {
    /// A model with what is known of its constants.
    ///
    /// # Errors
    /// If that is wrong.
    fn new(known: &KnownConstants, model: Model) -> Result<Self, Error> {
        let (tolerances, model) = known.applied_to(model)?;
        Ok(Self {
            model: Box::new(model),
            tolerances,
        })
    }
}

/// Whether the time of a search is one.
fn check_search(search: &Search) -> Result<(), Refusal> {
    if BUDGETS_S.contains(&search.budget_s) {
        Ok(())
    } else {
        let (low, high) = (BUDGETS_S.start(), BUDGETS_S.end());
        let what = format!("the time limit is {low} to {high} s");
        Err(Refusal::wrong(what))
    }
}

/// The explanation, if it starts from the present model.
fn present_explanation(session: &Session) -> Result<Arc<Explained>, Refusal> {
    let explained = session.present_explanation();
    let stale = || Refusal::conflict("the model has changed; run the explanation again");
    explained.cloned().ok_or_else(stale)
}

/// The effect of this name, if it fits the session's model and is not yet in it.
fn new_effect(session: &Session, name: &str) -> Result<&'static dyn Effect, Refusal> {
    lacking(session, find(&session.model(), name)?)
}

/// The effect, if the session's model does not have it.
fn lacking(session: &Session, effect: &'static dyn Effect) -> Result<&'static dyn Effect, Refusal> {
    let mut present = session.fit().estimate.effects.iter();
    if present.any(|added| added.effect.id() == effect.id()) {
        Err(Refusal::conflict("the model has this effect already"))
    } else {
        Ok(effect)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::Source;

    /// Bore, mm, from which a task of the page starts.
    fn starts_at_mm(session: &Session, task: serde_json::Value) -> Result<f64, Refusal> {
        let ready = Ready::new(session, serde_json::from_value(task).unwrap())?;
        let (What::Explain(_, start) | What::Constants(start)) = &ready.what else {
            panic!("no fit of constants");
        };
        Ok(1e3 * start.model.constants().cylinder.bore_m)
    }

    #[test]
    fn a_fit_and_an_explanation_of_constants_start_in_the_middle_of_a_range() {
        let source = Source {
            campaign: None,
            model: hitch_model_file::nominal(),
            baseline: None,
        };
        let session = Session::new(Arc::new(source.read().unwrap()));
        let declared_mm = 1e3 * session.subject().model.constants().cylinder.bore_m;
        let known = |text: &str| json!({ "within": [["cylinder.bore_mm", text]] });
        let middle_mm = f64::sqrt(80.0 * 82.0);
        for (task, wanted_mm) in [
            (
                json!({ "task": "constants", "known": known("80..82") }),
                middle_mm,
            ),
            (
                json!({ "task": "explain", "data_sheet": true, "known": known("80..82") }),
                middle_mm,
            ),
            (
                json!({ "task": "explain", "data_sheet": false, "known": known("80..82") }),
                declared_mm,
            ),
            (json!({ "task": "explain" }), declared_mm),
        ] {
            let start_mm = starts_at_mm(&session, task.clone()).ok().unwrap();
            assert!((start_mm - wanted_mm).abs() < 1e-9, "{task}: {start_mm} mm");
        }
        let wrong = json!({ "task": "constants", "known": known("wide") });
        assert!(starts_at_mm(&session, wrong).is_err());
    }
}
