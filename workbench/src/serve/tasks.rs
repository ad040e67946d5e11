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
use crate::arguments::effect::find;
use crate::arguments::search::BUDGET_S;
use crate::error::Error;

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
        /// Constants that are exact.
        hold: Vec<String>,
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
    /// Constants that are exact.
    hold: Vec<String>,
}

impl Default for Search {
    fn default() -> Self {
        Self {
            budget_s: BUDGET_S,
            data_sheet: false,
            hold: Vec::new(),
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

/// The tolerances of a fit that holds some constants.
fn held_exact(hold: &[String], model: &Model) -> Result<Tolerances, Refusal> {
    Tolerances::holding(hold, model.constants()).map_err(|what| Error::Usage(what).into())
}

/// A checked task.
enum What {
    Rank,
    Explain(Search, Tolerances),
    Constants(Tolerances),
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
                let own = held_exact(&search.hold, &session.subject().model)?;
                What::Explain(search, own)
            }
            Task::Constants { hold } => {
                What::Constants(held_exact(&hold, &session.subject().model)?)
            }
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
                let suggestion = present_explanation(session)?.suggestion.clone();
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
