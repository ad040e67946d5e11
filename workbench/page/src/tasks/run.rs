//! What the computations of a session do.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use hitch_identification::base::fit_base_model;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimate::Estimate;
use hitch_identification::estimation::fit::{Fit, evaluate, fit_loads, refine, short_fit};
use hitch_identification::explanation::diagnosis::diagnose_each;
use hitch_identification::residuals::whitening::Weights;
use hitch_identification::search::options::{Accuracy, Options};
use hitch_identification::search::single_effects::try_effects;
use hitch_identification::selection::hold_out::held_out;
use hitch_plant::{AddedEffect, Effect, Model, full_name};

use crate::jobs::Reporter;
use crate::parameters::keep_fixed;
use crate::second::Second;
use crate::session::{Explained, Ranking, Step};
use crate::tuned::TunedFor;
use crate::views::candidate::ShownCandidate;
use hitch_results::base_model::fit::ShownBaseFit;
use hitch_results::comparison::Evaluated;
use hitch_results::explanation;

use super::{Outcome, Ready, Search, Start, What};

/// Maximum number of rounds of a fit before the final one, and the relative decrease of the cost that continues it.
const ROUNDS: usize = 6;
const WORTHWHILE: f64 = 1e-3;

impl Ready {
    /// Runs the task.
    pub fn run(&self, reporter: &Reporter) -> Outcome {
        let before = &self.present.evaluated.fit;
        match &self.what {
            What::Rank => Outcome::Ranking(Arc::new(self.rank(reporter))),
            What::Explain(search, start) => {
                Outcome::Explained(Arc::new(self.explain(search, start, reporter)))
            }
            What::Constants(start) => self.constants(start, reporter),
            What::Tune(trials) => self.tune(*trials, reporter),
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
                let weights = Weights::new(self.problem(), estimate);
                let estimate = estimate.clone();
                let loaded = fit_loads(self.problem(), &weights, estimate);
                let fit = evaluate(self.problem(), loaded);
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

    /// The present model with its constants fitted, as the first model.
    fn constants(&self, start: &Start, reporter: &Reporter) -> Outcome {
        let (declared, tolerances) = (&start.model, &start.tolerances);
        let mut fit = fit_base_model(self.experiment(), declared, tolerances, &|what| {
            reporter.progress(what, None, None);
        });
        fit.model.name = format!("{}-fitted", self.subject.model.name);
        let shown = ShownBaseFit::new(self.experiment(), declared, &fit, String::new());
        match self.subject.exchanged(fit.model) {
            Ok(mut subject) => {
                subject.fitted = Some(shown);
                Outcome::First(Arc::new(subject))
            }
            Err(error) => Outcome::Failed(error.to_string()),
        }
    }

    /// The tuned calibration of the present model.
    fn tune(&self, trials: usize, reporter: &Reporter) -> Outcome {
        reporter.progress("computing the ideal manoeuvres", None, None);
        let of = Arc::clone(&self.present.evaluated);
        let tuned = TunedFor::search(of, &self.rebuilt, trials, |count, cost| {
            let share = count as f64 / trials as f64;
            reporter.progress(&format!("best cost {cost:.3}"), Some(share), None);
            reporter.goes_on()
        });
        match tuned {
            Ok(tuned) => Outcome::Tuned(Arc::new(tuned)),
            Err(error) => Outcome::Failed(error.to_string()),
        }
    }

    fn rank(&self, reporter: &Reporter) -> Ranking {
        reporter.progress("fitting the clocks and loads", None, None);
        let start = self.present.evaluated.fit.estimate.clone();
        let base = refine(self.problem(), start.with_adopted());
        reporter.progress("simulating every effect at a few sizes", None, None);
        let done = AtomicUsize::new(0);
        let diagnosis = diagnose_each(self.problem(), base.clone(), &|_| {}, &|candidate, all| {
            let share = (done.fetch_add(1, Ordering::Relaxed) + 1) as f64 / all as f64;
            reporter.candidate(ShownCandidate::tried(&base, candidate), share);
        });
        reporter.progress("comparing the best candidates", None, None);
        let shown = explanation::Diagnosis::new(self.experiment(), self.model(), &diagnosis);
        Ranking {
            of: Arc::clone(&self.present.evaluated),
            diagnosis,
            shown,
        }
    }

    fn explain(&self, search: &Search, start: &Start, reporter: &Reporter) -> Explained {
        let model = &start.model;
        reporter.progress("fitting the clocks and loads", None, None);
        let options = Options {
            limit: reporter.limit(search.budget_s),
            constants: if search.data_sheet {
                Accuracy::DataSheet
            } else {
                Accuracy::default()
            },
            tolerances: Some(&start.tolerances),
            ..Options::default()
        };
        let found = explanation::Explained::new(self.experiment(), model, options, &|what| {
            reporter.progress(&format!("trying {what}"), None, None);
        });
        Explained {
            of: Arc::clone(&self.present.evaluated),
            model: (**model).clone(),
            found,
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
        let base = &self.present.evaluated.fit;
        let tried = try_effects(self.problem(), base, &[effect], &|_| {
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
        estimate.adopted.clear();
        keep_fixed(&self.present.evaluated.fit.estimate, &mut estimate);
        let whole = (ROUNDS + 3) as f64;
        let told = |round: usize, text: &str, fit: &Fit| {
            reporter.progress(text, Some(round as f64 / whole), Some(fit.error()));
        };
        let mut fit = evaluate(self.problem(), estimate);
        told(0, "start", &fit);
        for round in 1..=ROUNDS {
            let descent = short_fit(self.problem(), &fit.weights, fit.estimate);
            fit = evaluate(self.problem(), descent.estimate);
            told(round, &format!("fitting, round {round}"), &fit);
            if descent.last_reduction <= WORTHWHILE * descent.cost {
                break;
            }
        }
        let fit = refine(self.problem(), fit.estimate);
        told(ROUNDS + 1, "evaluating held-out runs", &fit);
        let error = held_out(self.problem(), &fit).error;
        reporter.progress("done", Some(1.0), None);
        self.step(title, fit, Some(error))
    }

    /// The accepted steps of an explanation: step by step if all are accepted, else fitted together.
    fn adopted(&self, explained: &Explained, accepted: &[usize], reporter: &Reporter) -> Vec<Step> {
        let found = &explained.found.explanation;
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

    pub(super) fn name(&self, effect: usize) -> String {
        let effects = &self.present.evaluated.fit.estimate.effects;
        full_name(effects[effect].effect)
    }

    fn experiment(&self) -> &Experiment {
        self.subject.experiment()
    }

    fn model(&self) -> &Model {
        &self.model
    }

    fn problem(&self) -> Problem<'_> {
        Problem::new(self.experiment(), self.model())
    }
}
