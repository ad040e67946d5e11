//! Screening of terms: one simulation each, ranked by the cost reduction of the signature.

use hitch_effects::TermEffect;
use hitch_effects::expression::TermDefinition;
use hitch_plant::{AddedEffect, Effect};

use crate::data::problem::Problem;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::Jacobian;
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::residual_columns::{dot, huber_residuals};
use crate::parallel;

/// Size of the secant, in typical sizes: large enough for terms with a threshold, small enough for linear scaling.
const SIZE: f64 = 0.5;

/// The `count` terms with the largest cost reduction, without duplicates of a shape of a signal at a place, by cost
/// reduction.
#[must_use]
pub fn best(
    problem: Problem<'_>,
    fit: &Fit,
    definitions: Vec<TermDefinition>,
    count: usize,
) -> Vec<&'static TermEffect> {
    let jacobian = Jacobian::new(problem, &fit.weights, &fit.estimate);
    let projection = NuisanceProjection::new(&jacobian, &fit.estimate, 0..0);
    let base: Vec<Vec<f64>> = jacobian.runs.iter().map(|r| r.residual.clone()).collect();
    let left = projection.project(base.clone());
    let terms = definitions
        .into_iter()
        .filter_map(|definition| TermEffect::define(definition).ok());
    let mut ranked: Vec<(f64, &'static TermEffect)> = parallel::map(terms, |term| {
        let (size, moved) = secant(problem, fit, &base, term);
        let moved = projection.project(moved);
        (explained(term, size, &left, &moved), term)
    });
    ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then_with(|| a.1.id().cmp(b.1.id())));
    let mut chosen: Vec<&'static TermEffect> = Vec::new();
    for (_, term) in ranked {
        if chosen.len() == count {
            break;
        }
        if chosen.iter().all(|other| other.id() != term.id()) {
            chosen.push(term);
        }
    }
    chosen
}

/// The size of a small step, and the decrease of the residuals with it.
fn secant(
    problem: Problem<'_>,
    fit: &Fit,
    base: &[Vec<f64>],
    term: &'static TermEffect,
) -> (f64, Vec<Vec<f64>>) {
    let mut added = AddedEffect::typical(term);
    added.values[0] *= SIZE;
    let size = added.values[0];
    let mut estimate = fit.estimate.clone();
    estimate.effects.push(added);
    let moved = huber_residuals(problem, &fit.weights, &estimate);
    let signature = base
        .iter()
        .zip(moved)
        .map(|(base, moved)| base.iter().zip(moved).map(|(b, m)| b - m).collect())
        .collect();
    (size, signature)
}

/// Cost reduction of a term at its best size within its range, to first order.
fn explained(term: &TermEffect, size: f64, left: &[Vec<f64>], signature: &[Vec<f64>]) -> f64 {
    let product =
        |a: &[Vec<f64>], b: &[Vec<f64>]| -> f64 { a.iter().zip(b).map(|(a, b)| dot(a, b)).sum() };
    let square = product(signature, signature);
    // A signature below a thousandth of a sigma per sample is rounding error.
    let samples: usize = left.iter().map(Vec::len).sum();
    if square.is_nan() || square < 1e-6 * samples as f64 {
        return 0.0;
    }
    let pull = product(signature, left);
    let range = &term.parameters()[0];
    let steps = (pull / square).clamp(range.low / size, range.high / size);
    steps * (2.0 * pull - steps * square)
}
