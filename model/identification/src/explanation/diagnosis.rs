//! Diagnosis: every effect of the catalogue added to a model once, and ranked.

use crate::data::problem::Problem;
use crate::estimation::fit::{Fit, fit};
use crate::explanation::suspected_constants::{suspected, worthwhile_beside};
use crate::search::candidates::{Progress, showing};
use crate::search::single_effects::{confidences, try_each};
use crate::search::subset::FAINT;
use crate::selection::candidate::Candidate;
use crate::selection::constants_evidence::Comparison;

/// A campaign and a model with every effect of the catalogue added once.
#[derive(Debug, Clone)]
pub struct Diagnosis {
    /// The given model, with its nuisance parameters fitted.
    pub base: Fit,
    /// The effects, by decreasing probability.
    pub candidates: Vec<Candidate>,
    /// Probability of each candidate among all, none, and constants that are off.
    pub confidences: Vec<f64>,
    /// Probability that the declared constants are off, given the best candidate.
    pub constants_off: f64,
}

/// Adds each effect that the model lacks, one at a time.
#[must_use]
pub fn diagnose(problem: Problem<'_>, base: Fit, progress: Progress) -> Diagnosis {
    diagnose_each(problem, base, progress, &|_, _| {})
}

/// [`diagnose`] with a callback for each form once it is weighed, in any order, with the number of forms.
#[must_use]
pub fn diagnose_each(
    problem: Problem<'_>,
    base: Fit,
    progress: Progress,
    weighed: &(dyn Fn(&Candidate, usize) + Sync),
) -> Diagnosis {
    let absent = showing(problem, &base.estimate);
    let report = |candidate: &Candidate| weighed(candidate, absent.len());
    let candidates = try_each(problem, &base, &absent, progress, &report);
    let best = candidates.first().map_or(&base, |best| &best.fit);
    progress("the constants of the model");
    let constants_off = constants_off(problem, best, &base);
    let confidences = confidences(&candidates).into_iter();
    Diagnosis {
        confidences: confidences
            .map(|share| (1.0 - constants_off) * share)
            .collect(),
        base,
        candidates,
        constants_off,
    }
}

/// Probability that the declared constants are off, given the best fit with them and that without further effects.
fn constants_off(problem: Problem<'_>, declared: &Fit, base: &Fit) -> f64 {
    if declared.estimate.constants.is_some() || problem.experiment.is_beside_baseline() {
        return 0.0;
    }
    let is_faint = || base.cost < FAINT * declared.cost;
    let start = worthwhile_beside(problem, declared)
        .or_else(|| is_faint().then(|| suspected(problem, declared, &[base]))?);
    match start {
        Some(start) => Comparison::new(problem, &fit(problem, start)).probability_off(declared),
        None => 0.0,
    }
}
