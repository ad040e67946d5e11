//! Bounded Levenberg-Marquardt over effects, clocks and each run's nuisances.
//!
//! The general crates have no bounds and know nothing of the arrow shape of the normal equations (see
//! [`crate::estimation::jacobian`]), which makes a fit of 45 parameters cost as much as one of five.
//!
//! A Jacobian takes a simulation a parameter, a step takes one. So while steps bring what a Jacobian promised it is kept
//! and corrected by what they showed (Broyden 1965); a descent ends only where one made anew promises nothing more.

use hitch_plant::{Model, SizeResponse};

use crate::data::experiment::Experiment;
use crate::estimate::Step;
use crate::estimate::{Estimate, Shared};
use crate::estimation::jacobian::{Jacobian, SlowColumns, huber_residuals, square_sum};
use crate::residuals::whitening::Weights;

/// Jacobians after which the columns of clocks and loads, which hardly change, are computed anew.
const SLOW_EVERY: usize = 4;

/// Dampings tried for one step, the first of a descent, and how much larger each is than the one before.
const TRIES: usize = 4;
const FIRST_DAMPING: f64 = 1e-3;
const DAMPED_MORE: f64 = 30.0;

/// Relative fall of the cost that is still worth a step.
const WORTHWHILE: f64 = 1e-5;

/// Share of the promised fall of the cost that a step has to bring for its Jacobian to be kept, how often one is, and
/// fewest parameters of effects with which that saves more than the steps that it spoils.
const KEPT: f64 = 0.5;
const MOST_KEPT: usize = 3;
const WORTH_KEEPING: usize = 4;

/// Where a descent came to.
#[derive(Debug, Clone)]
pub struct Descent {
    /// The values found.
    pub estimate: Estimate,
    /// Sum of Huber's losses plus the cost of the priors.
    pub cost: f64,
    /// What the cost fell by in the last iteration.
    pub falling: f64,
}

/// What a descent moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Moves {
    /// All that is free.
    All,
    /// All but sizes of what jumps.
    AllButJumps,
}

/// Descends from `start` under given weights with at most so many Jacobians.
pub(crate) fn descend(
    experiment: &Experiment,
    model: &Model,
    weights: &Weights,
    start: Estimate,
    moves: Moves,
    jacobians: usize,
) -> Descent {
    let slopes = Slopes {
        experiment,
        model,
        weights,
        moves,
    };
    let mut point = slopes.point(start);
    let mut damping = FIRST_DAMPING;
    let mut slow = None;
    let mut falling = 0.0;
    for made in 0..jacobians {
        if made % SLOW_EVERY == 0 {
            slow = None;
        }
        let columns = slow.take().unwrap_or_else(|| slopes.slow_columns(&point));
        let mut jacobian = slopes.jacobian(&point, &columns);
        slow = Some(columns);
        let before = point.cost;
        let simulated = jacobian.shared.iter().filter(|shared| !shared.has_prior());
        let most_kept = match simulated.count() >= WORTH_KEEPING {
            true => MOST_KEPT,
            false => 0,
        };
        for kept in 0..=most_kept {
            let Some(taken) = slopes.step(&jacobian, &point, damping) else {
                break;
            };
            damping = (taken.damping * 0.1).max(1e-9);
            let fall = point.cost - taken.to.cost;
            let brings = fall >= KEPT * taken.promised && fall > WORTHWHILE * point.cost;
            let goes_on = brings && kept < most_kept && !taken.jumping;
            if goes_on {
                jacobian.correct(&taken.step, &taken.to.residuals, &taken.to.estimate);
            }
            point = taken.to;
            if !goes_on {
                break;
            }
        }
        falling = before - point.cost;
        if falling <= WORTHWHILE * before {
            break;
        }
    }
    Descent {
        estimate: point.estimate,
        cost: point.cost,
        falling,
    }
}

/// What is descended on.
struct Slopes<'a> {
    experiment: &'a Experiment,
    model: &'a Model,
    weights: &'a Weights,
    moves: Moves,
}

/// A step that was taken.
struct Taken {
    step: Step,
    to: Point,
    damping: f64,
    /// Fall of the cost that the Jacobian promised.
    promised: f64,
    /// Whether a parameter that jumps is free.
    jumping: bool,
}

impl Slopes<'_> {
    fn point(&self, estimate: Estimate) -> Point {
        let residuals = huber_residuals(self.experiment, self.model, self.weights, &estimate);
        let cost = square_sum(&residuals) + estimate.prior_cost();
        Point {
            estimate,
            residuals,
            cost,
        }
    }

    fn slow_columns(&self, point: &Point) -> SlowColumns {
        let (experiment, model, weights) = (self.experiment, self.model, self.weights);
        SlowColumns::new(
            experiment,
            model,
            weights,
            &point.estimate,
            &point.residuals,
        )
    }

    fn jacobian(&self, point: &Point, slow: &SlowColumns) -> Jacobian {
        let (experiment, model, weights) = (self.experiment, self.model, self.weights);
        let (estimate, residuals) = (&point.estimate, &point.residuals);
        Jacobian::with_slow_columns(experiment, model, weights, estimate, residuals, slow)
    }

    /// The first step, by rising damping, that lowers the cost.
    fn step(&self, jacobian: &Jacobian, point: &Point, damping: f64) -> Option<Taken> {
        // The slope of what jumps says little of where a step of it leads, and spoils that of all the others.
        let jumps = |shared| point.estimate.size_response(shared) == SizeResponse::Switching;
        let jumping = jacobian.shared.iter().any(|&shared| jumps(shared));
        let better = |held: &dyn Fn(Shared) -> bool, damping: f64| {
            let step = jacobian.step(&point.estimate, damping, held)?;
            let moved = point.estimate.moved(&jacobian.shared, &step);
            let step = moved.step_from(&point.estimate, &jacobian.shared);
            let promised = point.cost - jacobian.promised(&step) - moved.prior_cost();
            let to = self.point(moved);
            (to.cost < point.cost).then_some(Taken {
                step,
                to,
                damping,
                promised,
                jumping,
            })
        };
        let all = || dampings(damping).find_map(|damping| better(&|_| false, damping));
        let all_but_jumps = || dampings(FIRST_DAMPING).find_map(|damping| better(&jumps, damping));
        match self.moves {
            _ if !jumping => all(),
            Moves::All => all().or_else(all_but_jumps),
            Moves::AllButJumps => all_but_jumps(),
        }
    }
}

/// Dampings to try one after the other.
fn dampings(first: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(first), |&damping| Some(DAMPED_MORE * damping)).take(TRIES)
}

/// An estimate with what it leaves.
struct Point {
    estimate: Estimate,
    residuals: Vec<Vec<f64>>,
    cost: f64,
}
