//! Fits of promising sets of effects with the full model.

use crate::estimate::Estimate;
use crate::estimation::fit::{Fit, evaluate, evaluate_weighted, refine, short_fit};
use crate::estimation::jacobian::Jacobian;
use crate::estimation::least_squares::Descent;
use crate::estimation::residual_columns::huber_residuals;
use crate::parallel;
use crate::search::candidates::Progress;
use crate::search::coarse_view::Coarse;
use crate::search::line_search::line_searched;
use crate::search::options::Options;
use crate::search::projections::Projections;
use crate::search::promising_subsets::{CLOSE, NEAR};
use crate::selection::complexity_penalty::Penalty;
use crate::selection::posterior::{Refitted, key, key_of};

/// Most starts that get a short fit, and short fits that are refined.
const SHORT_FITS: usize = 5;
const REFINED: usize = 3;

/// The context of the fits.
pub(crate) struct Refits<'a> {
    pub coarse: &'a Coarse<'a>,
    /// Penalised cost of the best fit so far, on the condensed experiment.
    pub best: f64,
    pub penalty: Penalty,
    pub options: Options<'a>,
}

impl Refits<'_> {
    /// Fits from some starts. Each start is simulated once and pruned of members whose cost reduction is below their
    /// penalty. The best starts get a short fit under the present weights, the best of those a fit on coarse time
    /// steps, and those close to the best a fit to all samples.
    ///
    /// `jacobian` holds the sensitivities at the coarse fit.
    pub fn of(
        &self,
        starts: Vec<Estimate>,
        jacobian: &Jacobian,
        known: &Refitted,
        progress: Progress,
    ) -> Vec<Fit> {
        let (problem, present) = (self.coarse.problem, &self.coarse.seen);
        let coarse = self.coarse.with_coarse_steps();
        let projections = Projections::new(jacobian, &present.estimate);
        let residuals = |estimate: &Estimate| huber_residuals(coarse, &present.weights, estimate);
        let cost = |estimate: &Estimate| {
            let predicted = projections.of(estimate).cost_after(&residuals(estimate));
            predicted + self.penalty.of_all(estimate)
        };
        let starts = parallel::map(starts, |start| {
            (!self.options.is_over()).then(|| pruned(start, cost))
        });
        let mut starts = distinct(starts.into_iter().flatten().collect());
        starts.retain(|(_, start)| !known.contains(&key_of(start)));
        let short_fit = |start: Estimate| {
            let found = self.short_fit_from(start);
            (
                found.cost + self.penalty.of_all(&found.estimate),
                found.estimate,
            )
        };
        let unless_past_deadline =
            |start: Estimate| (!self.options.is_over()).then(|| short_fit(start));
        let starts = self.nearest(starts, SHORT_FITS);
        let short_fits = parallel::map(starts, unless_past_deadline);
        let short_fits = short_fits.into_iter().flatten().collect();
        let coarse_fits = parallel::map(self.nearest(short_fits, REFINED), |start| {
            (!self.options.is_over()).then(|| {
                let fit = refine(coarse, start);
                let (estimate, weights) = (fit.estimate.clone(), present.weights.clone());
                let under_present = evaluate_weighted(coarse, estimate, weights).cost;
                let cost = fit.cost.min(under_present) + self.penalty.of_all(&fit.estimate);
                (cost, fit)
            })
        });
        let likely = self.likely(coarse_fits.into_iter().flatten().collect());
        parallel::map(likely, |estimate| {
            let fit = self.line_searched(refine(problem, estimate));
            progress(&key(&fit).name());
            fit
        })
    }

    /// The coarse fits that may be the best on all samples: their penalised cost is close to the least one.
    fn likely(&self, coarse_fits: Vec<(f64, Fit)>) -> Vec<Estimate> {
        let Some((least, best)) = coarse_fits.iter().min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return Vec::new();
        };
        let least = least.min(self.best);
        let near = least + CLOSE * Penalty::given(&self.coarse.coarse_in_time, best).unit;
        let near = coarse_fits.iter().filter(|(cost, _)| *cost <= near);
        near.map(|(_, fit)| fit.estimate.clone()).collect()
    }

    /// At most `most` estimates whose penalised cost is close to the least one.
    fn nearest(&self, mut penalized: Vec<(f64, Estimate)>, most: usize) -> Vec<Estimate> {
        penalized.sort_by(|a, b| a.0.total_cmp(&b.0));
        let least = penalized
            .first()
            .map_or(self.best, |(cost, _)| cost.min(self.best));
        let present = &self.coarse.seen;
        let here = present.cost + self.penalty.of_all(&present.estimate);
        let near = least + (NEAR * (here - least)).max(CLOSE * self.penalty.unit);
        let near = penalized.into_iter().filter(|(cost, _)| *cost <= near);
        near.take(most).map(|(_, estimate)| estimate).collect()
    }

    /// The fit from one start.
    pub fn one(&self, start: Estimate) -> Fit {
        let found = self.short_fit_from(start);
        self.line_searched(refine(self.coarse.problem, found.estimate))
    }

    /// A short fit from one start on few samples, evaluated on all samples.
    pub fn one_roughly(&self, start: Estimate) -> Fit {
        let found = self.short_fit_from(start);
        let weights = self.coarse.present.weights.clone();
        evaluate_weighted(self.coarse.problem, found.estimate, weights)
    }

    /// A short fit under the present weights.
    fn short_fit_from(&self, start: Estimate) -> Descent {
        let weights = &self.coarse.seen.weights;
        short_fit(self.coarse.with_coarse_steps(), weights, start)
    }

    /// A fit after the line search for the size of each effect without useful slopes.
    fn line_searched(&self, fit: Fit) -> Fit {
        let rough = |fit: &Fit, index: &usize| {
            let response = fit.estimate.effects[*index].effect.size_response();
            response.is_rough()
        };
        let indices: Vec<usize> = fit
            .estimate
            .changed()
            .filter(|index| rough(&fit, index))
            .collect();
        let problem = self.coarse.problem;
        indices.into_iter().fold(fit, |fit, index| {
            line_searched(problem, evaluate(problem, fit.estimate), index)
        })
    }
}

/// An estimate without the members whose cost reduction is below their penalty, and its penalised cost.
fn pruned(start: Estimate, cost: impl Fn(&Estimate) -> f64) -> (f64, Estimate) {
    let (mut least, mut estimate) = (cost(&start), start);
    let mut index = 0;
    while index < estimate.effects.len() {
        if !estimate.is_unchanged(index) {
            let reduced = estimate.without(index);
            let without = cost(&reduced);
            if without < least {
                let removed = reduced.effects.len() < estimate.effects.len();
                (estimate, least) = (reduced, without);
                index += usize::from(!removed);
                continue;
            }
        }
        index += 1;
    }
    (least, estimate)
}

/// The best estimate of each set.
fn distinct(mut penalized: Vec<(f64, Estimate)>) -> Vec<(f64, Estimate)> {
    penalized.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut known = Vec::new();
    penalized.retain(|(_, estimate)| {
        let key = key_of(estimate);
        let is_new = !known.contains(&key);
        known.push(key);
        is_new
    });
    penalized
}
