//! Computations of a session: rank effects, fit a model, explain the campaign.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimate::Estimate;
use hitch_identification::estimation::fit::{Fit, evaluate, fit_loads, refine, short_fit};
use hitch_identification::explanation::diagnosis::diagnose_each;
use hitch_identification::residuals::whitening::Weights;
use hitch_identification::search::single_effects::try_effects;
use hitch_identification::search::subset::Options;
use hitch_identification::selection::hold_out::held_out;
use hitch_identification::suggestion::Suggestion;
use hitch_plant::{AddedEffect, Effect, Model, full_name};
use serde::Deserialize;

use super::jobs::Reporter;
use super::own_term::TermForm;
use super::parameters::{held, keep_fixed, moved};
use super::routes::Refusal;
use super::second::Second;
use super::session::{Explained, Ranking, Session, Step};
use super::source::Subject;
use super::views;
use crate::comparison::Evaluated;
use crate::effect_arg::find;
use crate::explanation;

/// Maximum number of rounds of a fit before the final one, and the relative decrease of the cost that continues it.
const ROUNDS: usize = 6;
const WORTHWHILE: f64 = 1e-3;

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
    Explain,
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

/// A task with its inputs.
pub struct Ready {
    subject: Arc<Subject>,
    model: Model,
    present: Step,
    ranking: Option<Arc<Ranking>>,
    what: What,
}

/// A checked task.
enum What {
    Rank,
    Explain,
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
}

impl Outcome {
    /// Stores the result in the session.
    pub fn apply(self, session: &mut Session) {
        match self {
            Self::Ranking(ranking) => session.ranking = Some(ranking),
            Self::Explained(explained) => session.explained = Some(explained),
            Self::Steps(steps) => steps.into_iter().for_each(|step| session.push(step)),
            Self::Second(second) => session.second = Some(second),
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
            Task::Explain => What::Explain,
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
            present,
            ranking: session.present_ranking().cloned(),
            what,
        })
    }

    /// Description of the computation, for the page.
    pub fn title(&self) -> String {
        match &self.what {
            What::Rank => "Evaluating every effect".to_owned(),
            What::Explain => "Explaining".to_owned(),
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
        matches!(self.what, What::Explain)
    }

    /// Runs the task.
    pub fn run(&self, reporter: &Reporter) -> Outcome {
        let before = &self.present.evaluated.fit;
        match &self.what {
            What::Rank => Outcome::Ranking(Arc::new(self.rank(reporter))),
            What::Explain => Outcome::Explained(Arc::new(self.explain(reporter))),
            What::Add(effect) => {
                let title = format!("Added {}", full_name(*effect));
                Outcome::Steps(vec![self.fitted(
                    title,
                    self.with(*effect, reporter),
                    reporter,
                )])
            }
            What::Remove(effect) => {
                let title = format!("Took {} away", self.name(*effect));
                let mut start = before.estimate.clone();
                start.effects.remove(*effect);
                Outcome::Steps(vec![self.fitted(title, start, reporter)])
            }
            What::Set(estimate, title) => {
                reporter.progress("evaluating all runs", None, None);
                let weights = Weights::new(Problem::new(self.experiment(), self.model()), estimate);
                let estimate = estimate.clone();
                let loaded = fit_loads(
                    Problem::new(self.experiment(), self.model()),
                    &weights,
                    estimate,
                );
                let fit = evaluate(Problem::new(self.experiment(), self.model()), loaded);
                Outcome::Steps(vec![self.step(title.clone(), fit, None)])
            }
            What::Fix(estimate, title) => {
                let fit = Fit {
                    estimate: estimate.clone(),
                    ..before.clone()
                };
                Outcome::Steps(vec![self.step(title.clone(), fit, self.present.held_out)])
            }
            What::Fit => {
                let start = before.estimate.clone();
                Outcome::Steps(vec![self.fitted("Fitted".to_owned(), start, reporter)])
            }
            What::Suggested(found) => {
                let title = format!("Accepted the explanation with {}", found.term.id());
                let start = found.fit.estimate.clone();
                Outcome::Steps(vec![self.fitted(title, start, reporter)])
            }
            What::Second(title, model) => {
                reporter.progress("fitting the clocks and loads", None, None);
                let (title, model) = (title.clone(), (**model).clone());
                Outcome::Second(Arc::new(Second::evaluate(&self.subject, title, model)))
            }
            What::Adopt(explained, steps) => {
                Outcome::Steps(self.adopted(explained, steps, reporter))
            }
        }
    }

    fn rank(&self, reporter: &Reporter) -> Ranking {
        reporter.progress("fitting the clocks and loads", None, None);
        let start = self.present.evaluated.fit.estimate.clone();
        let base = refine(
            Problem::new(self.experiment(), self.model()),
            start.with_adopted(),
        );
        reporter.progress("simulating every effect at a few sizes", None, None);
        let done = AtomicUsize::new(0);
        let diagnosis = diagnose_each(
            Problem::new(self.experiment(), self.model()),
            base.clone(),
            &|_| {},
            &|candidate, all| {
                let share = (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / all as f64;
                reporter.candidate(&views::tried(&base, candidate), share);
            },
        );
        reporter.progress("comparing the best candidates", None, None);
        let shown = explanation::Diagnosis::new(self.experiment(), self.model(), &diagnosis);
        Ranking {
            of: Arc::clone(&self.present.evaluated),
            diagnosis,
            shown,
        }
    }

    fn explain(&self, reporter: &Reporter) -> Explained {
        let estimate = &self.present.evaluated.fit.estimate;
        let model = estimate.applied_to(self.model());
        reporter.progress("fitting the clocks and loads", None, None);
        let options = Options {
            limit: reporter.limit(),
            ..Options::default()
        };
        let explained = explanation::Explained::new(self.experiment(), &model, options, &|what| {
            reporter.progress(&format!("trying {what}"), None, None);
        });
        let explanation::Explained {
            explanation,
            suggestion,
            shown,
        } = explained;
        Explained {
            suggestion,
            of: Arc::clone(&self.present.evaluated),
            explanation,
            shown,
        }
    }

    /// Initial estimate for the fit with one more effect.
    fn with(&self, effect: &'static dyn Effect, reporter: &Reporter) -> Estimate {
        reporter.progress(
            "estimating its size",
            None,
            Some(self.present.evaluated.fit.error()),
        );
        let ranking = self.ranking.as_ref();
        let ranked = ranking.and_then(|ranking| ranking.candidate(&full_name(effect)));
        if let Some(candidate) = ranked {
            return candidate.fit.estimate.clone();
        }
        let (experiment, model) = (self.experiment(), self.model());
        let base = &self.present.evaluated.fit;
        let tried = try_effects(Problem::new(experiment, model), base, &[effect], &|_| {
            reporter.progress("estimating its size", None, None);
        });
        let tried = tried.into_iter().next();
        tried.map_or_else(
            || {
                let mut start = base.estimate.clone();
                start.effects.push(AddedEffect::typical(effect));
                start
            },
            |candidate| candidate.fit.estimate,
        )
    }

    /// Fits all effects from an initial estimate; reports the error after each round.
    fn fitted(&self, title: String, mut estimate: Estimate, reporter: &Reporter) -> Step {
        let (experiment, model) = (self.experiment(), self.model());
        estimate.adopted.clear();
        keep_fixed(&self.present.evaluated.fit.estimate, &mut estimate);
        let whole = (ROUNDS + 3) as f64;
        let told = |round: usize, text: &str, fit: &Fit| {
            reporter.progress(text, Some(round as f64 / whole), Some(fit.error()));
        };
        let mut fit = evaluate(Problem::new(experiment, model), estimate);
        told(0, "start", &fit);
        for round in 1..=ROUNDS {
            let descent = short_fit(
                Problem::new(experiment, model),
                &fit.weights,
                fit.estimate,
                false,
            );
            fit = evaluate(Problem::new(experiment, model), descent.estimate);
            told(round, &format!("fitting, round {round}"), &fit);
            if descent.last_reduction <= WORTHWHILE * descent.cost {
                break;
            }
        }
        let fit = refine(Problem::new(experiment, model), fit.estimate);
        told(ROUNDS + 1, "evaluating held-out runs", &fit);
        let error = held_out(Problem::new(experiment, model), &fit).error;
        reporter.progress("done", Some(1.0), None);
        self.step(title, fit, Some(error))
    }

    /// The accepted steps of an explanation: step by step if all are accepted, else fitted together.
    fn adopted(&self, explained: &Explained, accepted: &[usize], reporter: &Reporter) -> Vec<Step> {
        let found = &explained.explanation;
        let fixed = &self.present.evaluated.fit.estimate.fixed;
        if fixed.is_empty() && (0..found.steps.len()).all(|step| accepted.contains(&step)) {
            let constants = found.corrected.iter().map(|corrected| {
                let title = "Fitted the constants".to_owned();
                self.step(title, corrected.fit.clone(), None)
            });
            let steps = found.steps.iter().map(|step| {
                let title = format!("Added {}", full_name(step.effect));
                self.step(title, step.fit.clone(), Some(step.held_out_after.error))
            });
            return constants.chain(steps).collect();
        }
        let mut start = found.after.estimate.clone();
        for (index, step) in found.steps.iter().enumerate() {
            let mut effects = start.effects.iter();
            let place = effects.position(|added| added.effect.id() == step.effect.id());
            if let (false, Some(place)) = (accepted.contains(&index), place) {
                start = start.without(place);
            }
        }
        vec![self.fitted("Accepted steps".to_owned(), start, reporter)]
    }

    fn step(&self, title: String, fit: Fit, held_out: Option<f64>) -> Step {
        let experiment = Arc::clone(&self.subject.start.experiment);
        Step {
            title,
            evaluated: Arc::new(Evaluated::fitted(experiment, fit, &self.subject.model)),
            held_out: held_out.filter(|error| error.is_finite()),
            terms: self.present.terms.clone(),
        }
    }

    fn name(&self, effect: usize) -> String {
        let effects = &self.present.evaluated.fit.estimate.effects;
        full_name(effects[effect].effect)
    }

    fn experiment(&self) -> &Experiment {
        self.subject.experiment()
    }

    fn model(&self) -> &Model {
        &self.model
    }
}

/// The explanation, if it starts from the present model.
fn present_explanation(session: &Session) -> Result<Arc<Explained>, Refusal> {
    let present = &session.present().evaluated;
    let explained = session.explained.as_ref();
    let explained = explained.filter(|known| Arc::ptr_eq(&known.of, present));
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
    match present.any(|added| added.effect.id() == effect.id()) {
        true => Err(Refusal::conflict("the model has this effect already")),
        false => Ok(effect),
    }
}
