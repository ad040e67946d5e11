//! Fine scan over the size of an effect whose cost has many local minima, on the most informative runs.
//!
//! A spool that sticks on a ramp jumps once per band: with a band that is two percent off, the twentieth jump comes at
//! the wrong time, and the fit is worse than without the effect. A pressure with ten visible oscillations is out of
//! phase once the stiffness is ten percent off. No secant leads to the minimum, but a few runs show it, and hundreds of
//! sizes are simulated in a second.

use hitch_plant::{AddedEffect, Model, Parameter};

use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::data::ready_run::ReadyRun;
use crate::data::regime::Regime;
use crate::estimation::fit::Fit;
use crate::estimation::residual_columns::residuals;
use crate::parallel;
use crate::search::shape_starts::scaled;
use crate::search::size_grid::{Grid, Informative, Spacing};

/// Results per shape that are scanned more closely, and in total.
const PER_SHAPE: usize = 2;
const SCANNED_CLOSELY: usize = 6;

/// Number of the best sizes on the informative runs that are evaluated on all runs, which may distinguish them better.
const EVALUATED_ON_ALL: usize = 60;

/// Values of a closer scan to either side.
const TO_EITHER_SIDE: i32 = 5;

/// Share of the sizes, those that are best on the first few of the informative runs, that are evaluated on the others,
/// and the number of these first runs.
const PRESELECTED: f64 = 0.25;
const FIRST_INFORMATIVE: usize = 2;

/// The sizes and shapes of an effect that fit best; `hint` is the effect at any size.
pub(crate) fn scan(
    problem: Problem<'_>,
    base: &Fit,
    hint: &AddedEffect,
    grid: &Grid,
) -> Vec<AddedEffect> {
    let Problem {
        experiment, model, ..
    } = problem;
    let failed = failed(base);
    let informative = match grid.informative {
        Informative::Changed => {
            let changed = changed(problem, base, hint);
            of_each_valve(experiment, &geometric_mean(&changed, &unexplained(base)))
        }
        Informative::Failed => most_informative_runs(experiment, &failed, INFORMATIVE_SAMPLES),
    };
    let scan = Scan {
        experiment,
        model: base.estimate.applied_to(model),
        base,
        informative,
    };
    let all: Vec<usize> = (0..experiment.runs.len()).collect();
    let without = failed.iter().enumerate();
    let visible: f64 = without
        .map(|(run, failed)| scan.negative_log_likelihood(run, grid.remaining_loss * failed))
        .sum();
    let ringing = experiment.ringing;
    let closer_count = if ringing { grid.best } else { SCANNED_CLOSELY };
    let mut best = scan.ranked(scan.better(coarse(hint, grid), grid, &all), &all);
    best.truncate(closer_count);
    best.retain(|(left, _)| *left < visible);
    for &reach in grid.closer {
        let closer = best.into_iter().map(|(_, added)| {
            let nearby = scan.ranked(around(&added, reach), &scan.informative);
            nearby
                .into_iter()
                .next()
                .map_or(added, |(_, nearest)| nearest)
        });
        best = scan.ranked(closer.collect(), &all);
        best.truncate(grid.best);
    }
    best.truncate(grid.best);
    without_losses(best)
}

/// The context of a scan.
#[derive(Clone)]
struct Scan<'a> {
    experiment: &'a Experiment,
    model: Model,
    base: &'a Fit,
    /// The informative runs, the most informative first.
    informative: Vec<usize>,
}

impl Scan<'_> {
    /// The same scan with a quasi-static model: its residuals mask narrow minima almost, but not those of the best
    /// sizes.
    fn as_quasi_static(&self) -> Self {
        Self {
            model: self.model.quasi_static(),
            ..self.clone()
        }
    }

    /// The best few sizes per shape on the informative runs and, if simulations are cheap, on all runs.
    fn better(&self, added: Vec<AddedEffect>, grid: &Grid, all: &[usize]) -> Vec<AddedEffect> {
        let rings = self.experiment.ringing;
        let seen = if grid.quasi_static {
            self.as_quasi_static()
        } else {
            self.clone()
        };
        let mut ranked = seen.preselected(added);
        if grid.quasi_static {
            ranked.truncate(EVALUATED_ON_ALL);
            ranked = seen.ranked(without_losses(ranked), all);
            if rings {
                ranked = self.ranked(without_losses(ranked), &self.informative);
            }
        }
        without_losses(spaced(ranked, grid.distance))
    }

    /// Negative log-likelihood of the residuals of some runs with an added effect.
    fn left(&self, added: &AddedEffect, runs: &[usize]) -> f64 {
        let mut effects = self.base.estimate.effects.clone();
        effects.push(added.clone());
        let model = self.model.with_effects(effects);
        let estimate = &self.base.estimate;
        let left = runs.iter().map(|&run| {
            let ready = &self.experiment.runs[run];
            let trace = ready.simulate(&model, estimate.nuisances[run], &estimate.clocks);
            let whitened = self.base.weights.runs[run].whiten(ready, &trace);
            self.negative_log_likelihood(run, whitened.into_iter().map(bounded_loss).sum())
        });
        left.sum()
    }

    /// Negative log-likelihood of a run's loss with unknown noise variance: a second missing effect that dominates some
    /// runs then does not affect the evaluation of the others.
    fn negative_log_likelihood(&self, run: usize, loss: f64) -> f64 {
        let samples = self.experiment.runs[run].len() as f64;
        samples * (loss / samples).ln_1p()
    }

    /// Added effects by their negative log-likelihood on some runs, ascending.
    fn ranked(&self, added: Vec<AddedEffect>, runs: &[usize]) -> Vec<(f64, AddedEffect)> {
        let mut ranked = parallel::map(added, |added| (self.left(&added, runs), added));
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        ranked
    }

    /// The better part of added effects by their negative log-likelihood on all informative runs, ascending.
    fn preselected(&self, added: Vec<AddedEffect>) -> Vec<(f64, AddedEffect)> {
        let most_informative = &self.informative[..self.informative.len().min(FIRST_INFORMATIVE)];
        let mut better = self.ranked(added, most_informative);
        better.truncate((PRESELECTED * better.len() as f64).ceil() as usize);
        self.ranked(without_losses(better), &self.informative)
    }
}

fn without_losses(ranked: Vec<(f64, AddedEffect)>) -> Vec<AddedEffect> {
    ranked.into_iter().map(|(_, added)| added).collect()
}

/// The best few per shape whose sizes are this share apart.
fn spaced(ranked: Vec<(f64, AddedEffect)>, share: f64) -> Vec<(f64, AddedEffect)> {
    let mut best: Vec<(f64, AddedEffect)> = Vec::new();
    for (loss, added) in ranked {
        let alike = |(_, other): &&(f64, AddedEffect)| added.values[1..] == other.values[1..];
        let far = |(_, other): &(f64, AddedEffect)| {
            let (a, b) = (added.values[0], other.values[0]);
            (a - b).abs() > share * a.abs().max(b.abs())
        };
        if best.iter().filter(alike).count() < PER_SHAPE && best.iter().filter(alike).all(far) {
            best.push((loss, added));
        }
    }
    best
}

/// Residual, in sigma, from which the loss is constant.
const BOUND: f64 = 3.0;

/// Sizes on either side of the hint whose loss has to differ in an informative run, as shares of the hint's.
const HINT_VARIATIONS: [f64; 2] = [0.9, 1.1];

/// Number of samples of the informative runs.
const INFORMATIVE_SAMPLES: usize = 1200;

/// Loss of a residual, constant beyond [`BOUND`]: the noise of the current decides whether a spool jumps at some
/// instants, and the samples after a missed jump must not dominate.
fn bounded_loss(residual: f64) -> f64 {
    (residual * residual).min(BOUND * BOUND)
}

/// Loss between two sizes of the effect in each run. A run that every size changes alike, like a plateau that is
/// reached from below, does not determine the size.
fn changed(problem: Problem<'_>, base: &Fit, hint: &AddedEffect) -> Vec<f64> {
    let [smaller, larger] = HINT_VARIATIONS.map(|share| {
        let mut with = base.estimate.clone();
        with.effects.push(scaled(hint, share));
        residuals(problem, &base.weights, &with)
    });
    let runs = smaller.iter().zip(&larger);
    runs.map(|(a, b)| a.iter().zip(b).map(|(a, b)| bounded_loss(a - b)).sum())
        .collect()
}

/// Loss of the model without the effect in each run.
fn failed(base: &Fit) -> Vec<f64> {
    let runs = base.residuals.iter();
    runs.map(|run| run.iter().copied().map(bounded_loss).sum())
        .collect()
}

/// Loss of the model without the effect in each run beyond that of noise.
fn unexplained(base: &Fit) -> Vec<f64> {
    let runs = failed(base).into_iter().zip(&base.weights.runs);
    runs.map(|(failed, weights)| {
        let noise: usize = (0..4).map(|channel| weights.compared(channel)).sum();
        (failed - noise as f64).max(0.0)
    })
    .collect()
}

/// The geometric mean of two losses in each run: a run that depends on the size is only informative if it has
/// unexplained residuals.
fn geometric_mean(one: &[f64], other: &[f64]) -> Vec<f64> {
    let runs = one.iter().zip(other);
    runs.map(|(one, other)| (one * other).sqrt()).collect()
}

/// Informative runs, most informative first, alternating between lifting and lowering if both exist: another missing
/// effect may spoil the runs of one valve.
fn of_each_valve(experiment: &Experiment, information: &[f64]) -> Vec<usize> {
    let [mut lifting, mut lowering] = [
        [Regime::Lifting, Regime::Lowering],
        [Regime::Lowering, Regime::Lifting],
    ]
    .map(|[wanted, other]| {
        let alone = |run: &ReadyRun| run.regimes.contains(&wanted) && !run.regimes.contains(&other);
        let information = experiment.runs.iter().zip(information);
        let information =
            information.map(|(run, &information)| if alone(run) { information } else { 0.0 });
        most_informative_runs(
            experiment,
            &information.collect::<Vec<_>>(),
            INFORMATIVE_SAMPLES / 2,
        )
        .into_iter()
    });
    if lifting.len().min(lowering.len()) == 0 {
        return most_informative_runs(experiment, information, INFORMATIVE_SAMPLES);
    }
    let pairs = std::iter::from_fn(|| {
        let pair = [lowering.next(), lifting.next()];
        pair.iter().any(Option::is_some).then_some(pair)
    });
    pairs.flatten().flatten().collect()
}

/// The most informative runs per sample, until `enough` samples are reached; `information` is per run.
fn most_informative_runs(
    experiment: &Experiment,
    information: &[f64],
    enough: usize,
) -> Vec<usize> {
    let density = |run: usize| information[run] / experiment.runs[run].regimes.len().max(1) as f64;
    let mut runs: Vec<usize> = (0..information.len())
        .filter(|&run| information[run] > 0.0)
        .collect();
    runs.sort_by(|&a, &b| density(b).total_cmp(&density(a)));
    let mut samples = 0;
    let few = |&run: &usize| {
        let too_few = samples < enough;
        samples += experiment.runs[run].len();
        too_few
    };
    runs.into_iter().take_while(few).collect()
}

/// The grid of all sizes and shapes, and the fine grid for narrow minima.
fn coarse(hint: &AddedEffect, grid: &Grid) -> Vec<AddedEffect> {
    let share = |k: usize| k as f64 / (grid.shapes - 1) as f64;
    let next = |size: f64| match grid.spacing {
        Spacing::Share(share) => size * (1.0 + share),
        Spacing::Even(step) => size + step,
    };
    let even = combinations(hint, |index, range| match index {
        0 => sizes(range, grid.sizes, next),
        1 => (0..grid.shapes)
            .map(|k| range.moved(range.low, share(k)))
            .collect(),
        other => vec![hint.values[other]],
    });
    let narrow_minima = grid
        .narrow_minima
        .as_ref()
        .map_or_else(Vec::new, |narrow_minima| {
            let next =
                |size: f64| size * (1.0 + (narrow_minima.finer * size).min(narrow_minima.coarsest));
            combinations(hint, |index, range| match index {
                0 => sizes(range, narrow_minima.sizes, next),
                _ => vec![range.high],
            })
        });
    [even, narrow_minima].concat()
}

/// Sizes from the smallest to the largest, in typical sizes, each followed by `next`.
fn sizes(size: &Parameter, [smallest, largest]: [f64; 2], next: impl Fn(f64) -> f64) -> Vec<f64> {
    std::iter::successors(Some(smallest), |&at| Some(next(at)))
        .take_while(|&at| at <= largest)
        .map(|at| size.null + at * (size.typical - size.null))
        .filter(|value| (size.low..=size.high).contains(value))
        .collect()
}

/// A grid of sizes and shapes around an effect.
fn around(at: &AddedEffect, (size_reach, shape_reach): (f64, f64)) -> Vec<AddedEffect> {
    combinations(at, |index, range| {
        let value = at.values[index];
        let mut values: Vec<f64> = (-TO_EITHER_SIDE..=TO_EITHER_SIDE)
            .map(|k| f64::from(k) / f64::from(TO_EITHER_SIDE))
            .map(|share| match index {
                0 => {
                    (value + size_reach * share * (value - range.null)).clamp(range.low, range.high)
                }
                _ => range.moved(value, shape_reach * share),
            })
            .collect();
        values.dedup();
        values
    })
}

/// All combinations of the values of an effect's parameters.
fn combinations(
    of: &AddedEffect,
    mut values: impl FnMut(usize, &Parameter) -> Vec<f64>,
) -> Vec<AddedEffect> {
    let parameters = of.effect.parameters().iter().enumerate();
    parameters.fold(vec![of.clone()], |grid, (index, range)| {
        let values = values(index, range);
        grid.iter()
            .flat_map(|added| {
                values.iter().map(|&value| {
                    let mut moved = added.clone();
                    moved.values[index] = value;
                    moved
                })
            })
            .collect()
    })
}
