//! An effect fitted in addition to the free parameters of a model, and its evidence.

use std::f64::consts::SQRT_2;

use hitch_plant::{AddedEffect, Effect, ParameterKind};

use crate::adequacy::lack_of_fit::{EXACT, SLOW_NOISE, TOLERATED_DISCREPANCY};
use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::estimate::Shared;
use crate::estimation::central_differences::with_central_differences;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::{Jacobian, RunJacobian};
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::profile_likelihood::ProfileLikelihood;
use crate::estimation::residual_columns::{difference, huber, huber_residuals, square_sum};
use crate::estimation::slow_columns::SlowColumns;
use crate::parallel;
use crate::selection::evidence::{detectability, log_odds, variance_inflation};

/// Ratio of the mean square that an effect explains to the remaining one, weighted by its signature, at which it is
/// equally probable to be itself or the closest match to an unknown effect. In drawn campaigns with physics outside the
/// catalogue the largest ratio was 17; in those with the effect itself 45 of 46 had more than 400 (benchmark
/// `hidden_effects`, steady rig, lab plan, seeds 1 to 60 and, with `--kind outside`, 101 to 130).
const EVEN_RATIO: f64 = 25.0;

/// Standard errors by which a mean square exceeds noise before it counts as lack of fit.
const SCATTERS: f64 = 2.0;

/// Systematic errors of currents (A), times (s) and ratios, one sigma: see [`systematic`].
const SYSTEMATIC_A: f64 = 0.000_9;
const SYSTEMATIC_S: f64 = 0.001;
const SYSTEMATIC_SHARE: f64 = 0.005;

/// An effect fitted in addition to the free parameters of a model.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// The effect.
    pub effect: &'static dyn Effect,
    /// The fitted model with it.
    pub fit: Fit,
    /// Index of the effect in the fit.
    pub index: usize,
    /// Reduction of the cost in units of the residual variance times the effect's variance inflation: approximately
    /// chi-squared with one degree of freedom if the effect is absent.
    pub likelihood_ratio: f64,
    /// Variance inflation of the effect.
    pub inflation: f64,
    /// Root mean square of its projected signature at the fitted size, in sigmas.
    pub detectability: f64,
    /// Share of the mean square beyond noise that the effect explains, weighted by its signature.
    pub explained_share: f64,
    /// 95 % confidence intervals of its parameters, in their units; NaN if the screening found nothing of the effect.
    pub intervals: Vec<(f64, f64)>,
}

impl Candidate {
    /// The candidate of an effect that the screening rejected, with a fit that contains it at its null value.
    #[must_use]
    pub fn absent(fit: Fit, index: usize) -> Self {
        let effect = fit.estimate.effects[index].effect;
        Self {
            effect,
            fit,
            index,
            likelihood_ratio: 0.0,
            inflation: 1.0,
            detectability: 0.0,
            explained_share: 0.0,
            intervals: vec![(f64::NAN, f64::NAN); effect.parameters().len()],
        }
    }

    /// Log-odds that the effect is present, less the penalty of its parameters.
    #[must_use]
    pub fn log_odds(&self) -> f64 {
        log_odds(
            self.likelihood_ratio,
            self.intervals.len(),
            self.effective_samples(),
        )
    }

    /// Effective number of compared samples.
    #[must_use]
    pub fn effective_samples(&self) -> f64 {
        self.fit.weights.count() as f64 / self.inflation
    }

    /// Probability that it is the named effect and not an unknown one: see [`plausibility`].
    #[must_use]
    pub fn plausibility(&self) -> f64 {
        plausibility(self.explained_share)
    }

    /// Fitted values of its parameters, in their units.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.fit.estimate.effects[self.index].values
    }
}

/// Probability that an effect is the named one and not the closest match to an unknown effect, from
/// [`Candidate::explained_share`].
///
/// A different mechanism never fits everywhere, and its residuals lie where the effect acts. The odds grow with the
/// square of the ratio of explained to remaining mean square there; they are even at a ratio of 25.
#[must_use]
pub fn plausibility(explained_share: f64) -> f64 {
    let left = EVEN_RATIO * (1.0 - explained_share);
    explained_share.powi(2) / (explained_share.powi(2) + left.powi(2)).max(f64::MIN_POSITIVE)
}

/// Weighs an effect of a fitted model, by its index, against the model without it.
#[must_use]
pub fn weigh(problem: Problem<'_>, base: &Fit, fit: Fit, index: usize) -> Candidate {
    let slow = slow_columns(problem, &fit);
    let jacobian = jacobian_by(problem, &fit, &slow);
    let jacobian = with_central_differences(problem, &fit, jacobian, index);
    weigh_with(problem, base, fit, index, &jacobian, Ends::Profile)
}

/// Columns of clocks and loads at a fit, from its residuals.
pub(crate) fn slow_columns(problem: Problem<'_>, fit: &Fit) -> SlowColumns {
    let residuals = huber(fit.residuals.clone());
    SlowColumns::new(problem, &fit.weights, &fit.estimate, &residuals)
}

/// Jacobian at a fit, from its residuals and the columns of clocks and loads there or nearby.
pub(crate) fn jacobian_by(problem: Problem<'_>, fit: &Fit, slow: &SlowColumns) -> Jacobian {
    let residuals = huber(fit.residuals.clone());
    let (weights, estimate) = (&fit.weights, &fit.estimate);
    Jacobian::with_slow_columns(problem, weights, estimate, &residuals, slow)
}

/// [`weigh`] for a fit near its optimum, with the columns of clocks and loads from a nearby estimate, forward differences, and
/// intervals from the curvature: accurate enough to rank effects.
pub(crate) fn weigh_by(
    problem: Problem<'_>,
    base: &Fit,
    fit: Fit,
    index: usize,
    slow: &SlowColumns,
) -> Candidate {
    let jacobian = jacobian_by(problem, &fit, slow);
    weigh_with(problem, base, fit, index, &jacobian, Ends::Curvature)
}

/// Method for the ends of intervals.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ends {
    /// The profile likelihood, which needs a fit at its optimum.
    Profile,
    /// The curvature of the cost.
    Curvature,
}

fn weigh_with(
    problem: Problem<'_>,
    base: &Fit,
    fit: Fit,
    index: usize,
    jacobian: &Jacobian,
    ends: Ends,
) -> Candidate {
    let Problem { experiment, .. } = problem;
    let effect = fit.estimate.effects[index].effect;
    let variance = fit.variance();
    let free = fit.estimate.free_parameters(effect.id());
    let signatures: Vec<Signature> = (0..effect.parameters().len().min(free))
        .map(|parameter| Signature::new(experiment, &fit, jacobian, index, parameter))
        .collect();
    let Evidence {
        detectability,
        inflation,
        explained_share,
    } = Evidence::new(problem, &fit, index, jacobian);
    let intervals = parallel::map(&signatures, |signature| {
        let deviation = (variance * signature.inflation / signature.square).sqrt();
        let value = fit.estimate.get(signature.shared);
        let range = &effect.parameters()[signature.parameter];
        let systematic =
            1.96 * systematic(&fit.estimate.effects[index], signature.parameter)
                .hypot(of_discrepancy(experiment, &fit, index, signature.parameter));
        let predicted = 1.96 * deviation * fit.estimate.scale(signature.shared);
        let profile = ProfileLikelihood {
            problem,
            fit: &fit,
            shared: signature.shared,
            projection: &signature.projection,
        };
        let rise = 1.96f64.powi(2) * variance * signature.inflation;
        let end = |half: f64| match ends {
            Ends::Profile if !problem.limit.is_over() => profile.end(half, rise),
            Ends::Profile | Ends::Curvature => half,
        };
        let [down, up] = [-predicted, predicted].map(end);
        (
            (value - down.hypot(systematic)).max(range.low),
            (value + up.hypot(systematic)).min(range.high),
        )
    });
    let [without, with] = base.compared(&fit);
    Candidate {
        effect,
        likelihood_ratio: (without - with) / (variance * inflation),
        inflation,
        detectability,
        explained_share,
        intervals,
        fit,
        index,
    }
}

/// Systematic error of an effect's parameter, one sigma, in its unit; it does not decrease with the number of samples.
///
/// A log locates the bend of a current ramp only to within a sample, and the remaining noise of the current keeps a
/// play open: about 0.9 mA, and a time of a tenth of a sample. Loads, areas and tables have errors of half a percent
/// that vary over the range, and so do shape parameters that compare one part of the range with another. The split of a
/// lag into its stages is uncertain by the same time.
pub(crate) fn systematic(added: &AddedEffect, parameter: usize) -> f64 {
    let (parameters, values) = (added.effect.parameters(), &added.values);
    let absolute = match (parameters[0].kind, parameters[parameter].kind) {
        (_, ParameterKind::Current) => SYSTEMATIC_A,
        (_, ParameterKind::Time) => SYSTEMATIC_S,
        (ParameterKind::Time, ParameterKind::Ratio) if values[0] > 0.0 => SYSTEMATIC_S / values[0],
        _ => 0.0,
    };
    let is_relative = parameter > 0 && parameters[parameter].kind == ParameterKind::Ratio;
    let whole = if is_relative { 1.0 } else { 0.0 };
    absolute.hypot(SYSTEMATIC_SHARE * values[parameter].abs().max(whole))
}

/// Error of a change of a parameter beside a baseline, one sigma, in its unit; zero without one. The model is wrong there, and
/// the response to a change is as wrong as the model's responses are, however much noise remains.
fn of_discrepancy(experiment: &Experiment, fit: &Fit, index: usize, parameter: usize) -> f64 {
    if !experiment.is_beside_baseline() {
        return 0.0;
    }
    let added = &fit.estimate.effects[index];
    let before = match (parameter, fit.estimate.adopted_as(added.effect.id())) {
        (0, Some(adopted)) => adopted.size,
        _ => added.effect.parameters()[parameter].null,
    };
    EXACT * (added.values[parameter] - before).abs()
}

/// A parameter's signature per step of one scale, with all other free parameters projected out.
struct Signature<'a> {
    parameter: usize,
    shared: Shared,
    /// Projection of all other free parameters.
    projection: NuisanceProjection<&'a Jacobian>,
    /// Squared norm of the projected signature, plus the prior cost of the removed part.
    square: f64,
    inflation: f64,
}

impl<'a> Signature<'a> {
    fn new(
        experiment: &Experiment,
        fit: &Fit,
        jacobian: &'a Jacobian,
        effect: usize,
        parameter: usize,
    ) -> Self {
        let shared = Shared::Effect(effect, parameter);
        let column = jacobian.shared.iter().position(|&s| s == shared);
        let own = column.map_or(0..0, |column| column..column + 1);
        let projection = NuisanceProjection::new(jacobian, &fit.estimate, own);
        let of_run = |run: &RunJacobian| match column {
            Some(column) => run.shared[column].clone(),
            None => vec![0.0; run.residual.len()],
        };
        let signature = jacobian.runs.iter().map(of_run).collect();
        let (projected, penalty) = projection.project_with_penalty(signature);
        Self {
            parameter,
            shared,
            projection,
            square: (square_sum(&projected) + penalty).max(1e-12),
            inflation: variance_inflation(experiment, &fit.residuals, &projected),
        }
    }
}

/// Evidence of an effect of a fit.
struct Evidence {
    /// Root mean square of its change of the residuals at the fitted size, in sigmas, with all other free parameters
    /// projected out.
    detectability: f64,
    /// Variance inflation of that change.
    inflation: f64,
    /// See [`explained_share`].
    explained_share: f64,
}

impl Evidence {
    /// Uses the whole change instead of its derivative: the derivative of an effect with a threshold or a switching
    /// effect overestimates it.
    fn new(problem: Problem<'_>, fit: &Fit, index: usize, jacobian: &Jacobian) -> Self {
        let without = fit.estimate.without(index);
        let without = huber_residuals(problem, &fit.weights, &without);
        let change = difference(&without, &huber(fit.residuals.clone()));
        let own = |shared: &Shared| matches!(shared, Shared::Effect(effect, _) if *effect == index);
        let columns = &jacobian.shared;
        let first = columns.iter().position(own).unwrap_or(0);
        let count = columns.iter().filter(|shared| own(shared)).count();
        let projection = NuisanceProjection::new(jacobian, &fit.estimate, first..first + count);
        let (left, penalty) = projection.project_within_range(change);
        Self {
            detectability: detectability(&left, penalty, fit.weights.count()),
            inflation: variance_inflation(problem.experiment, &fit.residuals, &left),
            explained_share: explained_share(
                problem.experiment,
                &left,
                &huber(fit.residuals.clone()),
            ),
        }
    }
}

/// Share of the mean square beyond noise that an effect explains, both weighted by its squared change of the residuals.
/// Residuals elsewhere do not count, as they say nothing about this effect. A wrong effect in place of the true one
/// leaves residuals where it acts. What the model leaves on a baseline as well is noise: its error is one and the same over
/// many samples, so that their mean square scatters as the square of a single number. The effect in turn has to explain more than
/// such an error: at the largest tolerated one its plausibility is even.
pub(crate) fn explained_share(
    experiment: &Experiment,
    changes: &[Vec<f64>],
    residuals: &[Vec<f64>],
) -> f64 {
    let (mut weight, mut weight_square, mut explained, mut left) = (0.0, 0.0, 0.0, 0.0);
    let mut discrepancy = 0.0;
    for (run, (changes, residuals)) in experiment.runs.iter().zip(changes.iter().zip(residuals)) {
        for (at, (change, residual)) in changes.iter().zip(residuals).enumerate() {
            let square = change * change;
            weight += square;
            weight_square += square * square;
            explained += square * square;
            left += square * (residual * residual - 1.0);
            // Nothing is known of a state that the baseline does not show.
            discrepancy += square * run.discrepancy(at).unwrap_or(1.0);
        }
    }
    if weight == 0.0 {
        return 0.0;
    }
    // Standard error of the weighted mean square of partly slow noise, and of a square of one number.
    let scatter = (2.0 * SLOW_NOISE * weight_square).sqrt() / weight;
    let scatter = scatter.hypot(SQRT_2 * discrepancy / weight);
    let left = (left / weight - SCATTERS * scatter).max(0.0);
    let imitated = TOLERATED_DISCREPANCY / EVEN_RATIO * discrepancy / weight;
    let explained = explained / weight;
    explained / (explained + left + imitated)
}
