//! Whether constants that are off explain a campaign as well as effects do.

use crate::constants::free::FreeConstants;
use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::fit::{Fit, evaluate_weighted, fit, short_fit};
use crate::residuals::whitening::Weights;
use crate::search::coarse_view::Coarse;
use crate::search::subset::FAINT;
use crate::selection::complexity_penalty::Penalty;
use crate::selection::constants_cost::{ConstantsCost, least_share, shares};

/// Most priors of the constants that are tried one after the other.
const PRIORS: usize = 3;

/// Smallest difference of the penalised costs, in units of the likelihood ratio, that counts as better.
const BETTER: f64 = 2.0;

/// Free constants beside the effects of a fit.
struct Inaccurate {
    /// The fit that they were compared with.
    fit: Fit,
    /// The same effects with free constants.
    estimate: Estimate,
    /// Penalised cost with free constants.
    cost: f64,
}

/// Where and how fits with free constants are compared.
#[derive(Clone, Copy)]
struct Trial<'a> {
    /// The condensed experiment.
    problem: Problem<'a>,
    /// Weights of the residuals.
    weights: &'a Weights,
    penalty: Penalty,
}

impl Trial<'_> {
    fn penalized(self, fit: &Fit) -> f64 {
        fit.cost + self.penalty.of_all(&fit.estimate)
    }

    /// Penalised cost of a fit. Declared constants have the accuracy of any model.
    fn cost(self, fit: &Fit) -> f64 {
        if let Some(free) = &fit.estimate.constants {
            let constants = ConstantsCost::at(self.problem, fit);
            return self.penalized(fit) + constants.price(free.share(), self.penalty);
        }
        let start = fit.estimate.clone();
        let share = least_share(self.penalty);
        self.penalized(&self.short_fit(start.with_free_constants(self.problem.model, share)))
    }

    /// Free constants beside the effects of a fit, with the most probable prior. It is chosen to first order, and again at
    /// the fit with it. They are not fitted if the prediction is above a limit.
    fn beside(self, fit: Fit, limit: f64) -> Inaccurate {
        let mut near = fit.clone();
        let mut cost = f64::INFINITY;
        for _ in 0..PRIORS {
            let constants = ConstantsCost::at(self.problem, &near);
            let predicted = |share| self.penalized(&near) - constants.gain(share, self.penalty);
            let least = |a: &f64, b: &f64| predicted(*a).total_cmp(&predicted(*b));
            let shares = shares(self.penalty).into_iter();
            let share = shares.min_by(least).unwrap_or(1.0);
            let present = near.estimate.constants.as_ref().map(FreeConstants::share);
            if present == Some(share) {
                cost = self.penalized(&near) + constants.price(share, self.penalty);
                break;
            }
            cost = predicted(share);
            if cost > limit {
                break;
            }
            let start = near.estimate.clone();
            near = self.short_fit(start.with_free_constants(self.problem.model, share));
        }
        Inaccurate {
            estimate: near.estimate,
            cost,
            fit,
        }
    }

    /// The best of those with an effect less.
    fn with_one_less(self, than: &Inaccurate, limit: f64) -> Option<Inaccurate> {
        let estimate = &than.fit.estimate;
        let without = estimate.changed().map(|effect| {
            let fit = self.short_fit(estimate.without(effect));
            self.beside(fit, limit)
        });
        without.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    fn short_fit(self, start: Estimate) -> Fit {
        let found = short_fit(self.problem, self.weights, start);
        evaluate_weighted(self.problem, found.estimate, self.weights.clone())
    }
}

/// Constants that are free within their tolerances beside the effects of a fit, if these reduce its penalised cost to first
/// order, on the condensed experiment.
pub(crate) fn worthwhile_beside(problem: Problem<'_>, declared: &Fit) -> Option<Estimate> {
    const WHOLE: f64 = 1.0;
    let coarse = Coarse::new(problem, declared);
    let penalty = Penalty::given(&coarse.few, &coarse.seen);
    let constants = ConstantsCost::at(coarse.condensed(), &coarse.seen);
    let estimate = declared.estimate.clone();
    let is_worthwhile = constants.gain(WHOLE, penalty) > 0.0;
    is_worthwhile.then(|| estimate.with_free_constants(problem.model, WHOLE))
}

/// Effects with free constants, if constants that are off by more than the accuracy of any model, or fewer effects, are
/// better than the best fit, on the condensed experiment. The constants of that fit may be free; another prior is then tried.
///
/// Constants that are off need faint effects in their place. They are therefore also tried at fits with fewer effects, and at
/// the best fit without the effects that are not needed beside them.
pub(crate) fn suspected(problem: Problem<'_>, best: &Fit, fewer: &[&Fit]) -> Option<Estimate> {
    let coarse = Coarse::new(problem, best);
    let mut trial = Trial {
        problem: coarse.condensed(),
        weights: &coarse.seen.weights,
        penalty: Penalty::given(&coarse.few, &coarse.seen),
    };
    // The residuals of the most flexible model are the best estimate of what no hypothesis explains.
    let widest = coarse.seen.estimate.clone();
    let widest = fit(
        trial.problem,
        widest.with_free_constants(problem.model, 1.0),
    );
    trial.penalty = Penalty::given(&coarse.few, &widest);
    let present = trial.cost(&coarse.seen);
    let limit = FAINT * present;
    let mut found = trial.beside(coarse.seen.clone(), limit);
    while let Some(without) = trial.with_one_less(&found, limit)
        && without.cost < found.cost
    {
        found = without;
    }
    for fit in fewer {
        let (estimate, weights) = (fit.estimate.clone(), trial.weights.clone());
        let fit = evaluate_weighted(trial.problem, estimate, weights);
        let other = trial.beside(fit, limit);
        if other.cost < found.cost {
            found = other;
        }
    }
    (found.cost < present - BETTER * trial.penalty.unit).then_some(found.estimate)
}
