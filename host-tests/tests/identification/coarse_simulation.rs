//! Coarse simulations and condensed runs lead to the same search results as fine simulations of all samples.

use std::path::Path;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimate::Estimate;
use hitch_identification::estimation::fit::evaluate;
use hitch_identification::estimation::residual_columns::{difference, residuals, square_sum};
use hitch_identification::explanation::explain::fit_base;
use hitch_identification::residuals::whitening::Weights;
use hitch_plant::{AddedEffect, Effect, Model};

/// Largest error of a coarse signature relative to the fine one, root mean square: an angle of 14 degrees, where
/// signatures within 37 degrees are fitted.
const BAR: f64 = 0.25;

/// Size below which a change is not a signature, sigma root mean square.
const NO_SIGNATURE: f64 = 0.02;

/// A shipped campaign made ready for a model.
fn ready(campaign: &str, model: Model) -> (Experiment, Model) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns");
    let campaign = Campaign::load(&folder.join(campaign)).expect("a campaign");
    (Experiment::new(&campaign, &model), model)
}

/// A campaign with the simulation of the dynamic model.
struct Compared {
    experiment: Experiment,
    model: Model,
    estimate: Estimate,
    weights: Weights,
}

impl Compared {
    fn new() -> Self {
        let (experiment, model) = ready("clean-dynamic", hitch_model_file::dynamic());
        let estimate = Estimate::new(&experiment, Vec::new());
        let weights = Weights::new(Problem::new(&experiment, &model), &estimate);
        Self {
            experiment,
            model,
            estimate,
            weights,
        }
    }

    fn coarse_in_time(&self) -> Experiment {
        let fitted = self.estimate.applied_to(&self.model);
        self.experiment
            .coarse_in_time(&fitted, &self.estimate.nuisances)
    }

    /// Residuals with and without an effect.
    fn left(&self, experiment: &Experiment, added: Option<AddedEffect>) -> Vec<Vec<f64>> {
        let mut estimate = self.estimate.clone();
        estimate.effects.extend(added);
        residuals(
            Problem::new(experiment, &self.model),
            &self.weights,
            &estimate,
        )
    }

    /// Signature of an effect of typical size.
    fn signature(&self, experiment: &Experiment, effect: &'static dyn Effect) -> Vec<Vec<f64>> {
        let with = self.left(experiment, Some(AddedEffect::typical(effect)));
        difference(&with, &self.left(experiment, None))
    }
}

#[test]
fn a_coarse_simulation_is_exact_at_the_start_of_the_search() {
    let compared = Compared::new();
    let [fine, draft] =
        [&compared.experiment, &compared.coarse_in_time()].map(|runs| compared.left(runs, None));
    assert!(square_sum(&difference(&fine, &draft)) < 1e-12);
}

#[test]
fn a_coarse_simulation_shows_the_change_of_an_effect() {
    let compared = Compared::new();
    let drafted = compared.coarse_in_time();
    let samples = compared.weights.count() as f64;
    let mut otherwise = Vec::new();
    for effect in hitch_effects::available(&compared.model) {
        let fine = compared.signature(&compared.experiment, effect);
        let off = difference(&fine, &compared.signature(&drafted, effect));
        let [size, off] = [&fine, &off].map(|of| (square_sum(of) / samples).sqrt());
        if size > NO_SIGNATURE && off > BAR * size {
            otherwise.push((effect.id(), off, size));
        }
    }
    assert!(otherwise.is_empty(), "{otherwise:?}");
}

/// Range of the sum of squares of a signature in a condensed experiment, relative to that of all samples.
const SHOWN: std::ops::RangeInclusive<f64> = 0.8..=1.2;

/// Sum of squares of the signature of an effect of typical size, in the sigmas of some runs.
fn shown(
    runs: &Experiment,
    model: &Model,
    estimate: &Estimate,
    effect: &'static dyn Effect,
) -> f64 {
    let weights = Weights::new(Problem::new(runs, model), estimate);
    let mut with = estimate.clone();
    with.effects.push(AddedEffect::typical(effect));
    let [with, without] =
        [&with, estimate].map(|estimate| residuals(Problem::new(runs, model), &weights, estimate));
    square_sum(&difference(&with, &without))
}

#[test]
fn a_condensed_experiment_shows_the_change_of_an_effect() {
    let (experiment, model) = ready("clean-steady", hitch_model_file::nominal());
    let estimate = Estimate::new(&experiment, Vec::new());
    let condensed = experiment.condensed(&model, &estimate.nuisances);
    assert!(2 * condensed.samples() < experiment.samples());
    let visible = NO_SIGNATURE * NO_SIGNATURE * experiment.samples() as f64;
    let mut otherwise = Vec::new();
    for effect in hitch_effects::available(&model) {
        let [all, few] =
            [&experiment, &condensed].map(|runs| shown(runs, &model, &estimate, effect));
        if all > visible && !SHOWN.contains(&(few / all)) {
            otherwise.push((effect.id(), effect.form(), few, all));
        }
    }
    assert!(otherwise.is_empty(), "{otherwise:?}");
}

#[test]
fn a_condensed_experiment_has_the_residuals_of_noise() {
    let (experiment, model) = ready("clean-steady", hitch_model_file::nominal());
    let base = fit_base(Problem::new(&experiment, &model));
    let condensed = experiment.condensed(&model, &base.estimate.nuisances);
    let seen = evaluate(Problem::new(&condensed, &model), base.estimate);
    let variance = square_sum(&seen.residuals) / seen.weights.count() as f64;
    assert!((0.85..1.15).contains(&variance), "{variance}");
}
