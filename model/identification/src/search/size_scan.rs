//! A fine search for the size of an effect whose cost has many valleys, on the runs that tell most of it.
//!
//! A spool that sticks on a ramp jumps once a band: with a band that is a fiftieth off, the twentieth jump comes at
//! the wrong time, and the fit is worse than without the effect. A pressure that rings ten times before it has died
//! away is out of step with the model's as soon as the stiffness is a tenth off. No secant leads there. But a few runs
//! are enough to see it, and a second of computing goes through hundreds of sizes.

use hitch_plant::{AddedEffect, Model, Parameter};
use rayon::prelude::*;

use crate::data::experiment::{Experiment, ReadyRun};
use crate::data::regime::Regime;
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::residuals;
use crate::search::shape_starts::scaled;

/// What is looked through, and how finely.
pub(crate) struct Grid {
    /// Smallest and largest size, in typical sizes.
    sizes: [f64; 2],
    /// How far a size is from the one before.
    step: Step,
    /// Which runs are looked at.
    telling: Telling,
    /// What makes narrow_valleys.
    narrow_valleys: Option<NarrowValleys>,
    /// How far to either side of what the telling runs found all runs are looked at, as a share of the size.
    all_runs: f64,
    /// Values of the first shape from one end of its range to the other, by its magnitude if that is what counts; a fit
    /// finds the others from where the effect has them.
    shapes: usize,
    /// How far two sizes of a shape are apart at least, as a share of the size.
    apart: f64,
    /// How many are kept after a closer look.
    best: usize,
    /// The closer looks at them: how far to either side, as a share of the size and of the range of a shape.
    closer: &'static [(f64, f64)],
    /// Whether it is seen without the ringing of the pressure, at a tenth of the time.
    quasi_static: bool,
    /// Whether secants see something of it: what they find next to nothing of is not there.
    pub hinted: bool,
    /// Share of the telling runs' loss without the effect that it may leave at most to be looked at more closely. While
    /// loads and clocks stand in for what is missing, the right place may leave nearly all of a loss that is bounded.
    leaves: f64,
}

/// Sizes with the shape at its upper end: a spool that sticks on a ramp and jumps by the whole band comes to the same
/// places again and again, so that the smaller a band is, the closer it has to be met.
#[derive(Clone, Copy)]
struct NarrowValleys {
    /// Smallest and largest size, in typical sizes.
    sizes: [f64; 2],
    /// Share by which a size is larger than the one before, for each typical size, and at most.
    finer: f64,
    coarsest: f64,
}

/// How far a size is from the one before.
#[derive(Clone, Copy)]
enum Step {
    /// A share of it.
    Share(f64),
    /// So many typical sizes.
    Even(f64),
}

/// The runs that tell most of an effect.
#[derive(Clone, Copy)]
enum Telling {
    /// Those that a size changes which is a little off.
    Changed,
    /// Those that the model fails without it.
    Failed,
}

/// For jumps and bounces.
pub(crate) static JUMPS: Grid = Grid {
    sizes: [0.12, 4.0],
    step: Step::Share(0.008),
    telling: Telling::Changed,
    narrow_valleys: Some(NarrowValleys {
        sizes: [0.25, 3.0],
        finer: 0.003,
        coarsest: 0.004,
    }),
    all_runs: 0.005,
    shapes: 3,
    apart: 0.03,
    best: 2,
    closer: &[(0.01, 0.25), (0.002, 0.05), (0.000_4, 0.01)],
    quasi_static: true,
    hinted: true,
    leaves: 0.92,
};

/// For ringing: a valley reaches a seventh of the size to either side, and descending from there needs no closer look.
pub(crate) static RINGING: Grid = Grid {
    sizes: [0.1, 8.0],
    step: Step::Share(0.06),
    telling: Telling::Changed,
    narrow_valleys: None,
    all_runs: 0.0,
    shapes: 5,
    apart: 0.1,
    best: 4,
    closer: &[],
    quasi_static: false,
    hinted: false,
    leaves: f64::INFINITY,
};

/// For what is met somewhere: what stands at the place or comes down on it is right within a few millimetres, and what
/// rings on it has a valley for every period.
pub(crate) static PLACES: Grid = Grid {
    sizes: [0.1, 6.5],
    step: Step::Even(0.06),
    telling: Telling::Failed,
    narrow_valleys: None,
    all_runs: 0.0,
    shapes: 5,
    apart: 0.05,
    best: 2,
    closer: &[(0.04, 0.125)],
    quasi_static: true,
    hinted: false,
    leaves: f64::INFINITY,
};

/// The same where nothing rings: secants see what stands at the place, though not how stiff it is.
pub(crate) static PLACES_AT_REST: Grid = Grid {
    hinted: true,
    ..PLACES
};

/// Sizes of each shape that are looked at more closely, and of all shapes.
const PER_SHAPE: usize = 2;
const LOOKED_AT: usize = 6;

/// How many of the sizes that fit the telling runs best are tried on all: what little tells those apart may tell others
/// well.
const SEEN_BY_ALL: usize = 60;

/// Values of a closer look to either side.
const TO_EITHER_SIDE: i32 = 5;

/// Share of the sizes, the best on so many of the most telling runs, that are tried on the others.
const WINNOWED: f64 = 0.25;
const MOST_TELLING: usize = 2;

/// The sizes and shapes of an effect around those that fit the runs best which tell them apart; `hint` is any size of
/// it.
pub(crate) fn scan(
    experiment: &Experiment,
    model: &Model,
    base: &Fit,
    hint: &AddedEffect,
    grid: &Grid,
) -> Vec<AddedEffect> {
    let failed = failed(base);
    let telling = match grid.telling {
        Telling::Changed => {
            let changed = changed(experiment, model, base, hint);
            of_each_valve(experiment, &both(&changed, &unexplained(base)))
        }
        Telling::Failed => enough(experiment, &failed, ENOUGH),
    };
    let scan = Scan {
        experiment,
        model: model.clone(),
        base,
        telling,
    };
    let all: Vec<usize> = (0..experiment.runs.len()).collect();
    let without = failed.iter().enumerate();
    let visible: f64 = without
        .map(|(run, failed)| scan.unlikely(run, grid.leaves * failed))
        .sum();
    let ringing = experiment.ringing;
    let looked_at = if ringing { grid.best } else { LOOKED_AT };
    let mut best = scan.ranked(scan.better(coarse(hint, grid), grid, &all), &all);
    best.truncate(looked_at);
    best.retain(|(left, _)| *left < visible);
    for &reach in grid.closer {
        let closer = best.into_iter().map(|(_, added)| {
            let nearby = scan.ranked(around(&added, reach), &scan.telling);
            nearby
                .into_iter()
                .next()
                .map_or(added, |(_, nearest)| nearest)
        });
        best = scan.ranked(closer.collect(), &all);
        best.truncate(grid.best);
    }
    best.truncate(grid.best);
    best.into_iter()
        .flat_map(|(_, added)| around(&added, (grid.all_runs, 0.0)))
        .collect()
}

/// What is scanned.
#[derive(Clone)]
struct Scan<'a> {
    experiment: &'a Experiment,
    model: Model,
    base: &'a Fit,
    /// The runs that are looked at, the most telling first.
    telling: Vec<usize>,
}

impl Scan<'_> {
    /// The same seen without the ringing of the pressure: what that leaves all but hides a narrow_valleys, but not from the
    /// better ones.
    fn still(&self) -> Self {
        Self {
            model: self.model.quasi_static(),
            ..self.clone()
        }
    }

    /// A few of many added effects, of every shape those that fit the telling runs best and, where simulating takes
    /// little, all runs.
    fn better(&self, added: Vec<AddedEffect>, grid: &Grid, all: &[usize]) -> Vec<AddedEffect> {
        let rings = self.experiment.ringing;
        let seen = if grid.quasi_static {
            self.still()
        } else {
            self.clone()
        };
        let mut ranked = seen.winnowed(added);
        if grid.quasi_static {
            ranked.truncate(SEEN_BY_ALL);
            ranked = seen.ranked(without_losses(ranked), all);
            if rings {
                ranked = self.ranked(without_losses(ranked), &self.telling);
            }
        }
        without_losses(apart(ranked, grid.apart))
    }

    /// How little likely what an added effect leaves of some runs is.
    fn left(&self, added: &AddedEffect, runs: &[usize]) -> f64 {
        let mut effects = self.base.estimate.effects.clone();
        effects.push(added.clone());
        let model = self.model.with_effects(effects);
        let estimate = &self.base.estimate;
        let left = runs.iter().map(|&run| {
            let ready = &self.experiment.runs[run];
            let trace = ready.simulate(&model, estimate.nuisances[run], &estimate.clocks);
            let whitened = self.base.weights.runs[run].whiten(ready, &trace);
            self.unlikely(run, whitened.into_iter().map(bounded_loss).sum())
        });
        left.sum()
    }

    /// How little likely a loss of a run is whose noise may be of any size: another effect that is missing still, and
    /// that some runs alone are full of, has no say in those that an effect explains.
    fn unlikely(&self, run: usize, loss: f64) -> f64 {
        let samples = self.experiment.runs[run].len() as f64;
        samples * (loss / samples).ln_1p()
    }

    /// Added effects by what they leave on some runs, the best first.
    fn ranked(&self, added: Vec<AddedEffect>, runs: &[usize]) -> Vec<(f64, AddedEffect)> {
        let mut ranked: Vec<(f64, AddedEffect)> = added
            .into_par_iter()
            .map(|added| (self.left(&added, runs), added))
            .collect();
        ranked.sort_by(|a, b| a.0.total_cmp(&b.0));
        ranked
    }

    /// The better ones of added effects by what they leave on all telling runs, the best first.
    fn winnowed(&self, added: Vec<AddedEffect>) -> Vec<(f64, AddedEffect)> {
        let most_telling = &self.telling[..self.telling.len().min(MOST_TELLING)];
        let mut better = self.ranked(added, most_telling);
        better.truncate((WINNOWED * better.len() as f64).ceil() as usize);
        self.ranked(without_losses(better), &self.telling)
    }
}

fn without_losses(ranked: Vec<(f64, AddedEffect)>) -> Vec<AddedEffect> {
    ranked.into_iter().map(|(_, added)| added).collect()
}

/// The best few of every shape whose sizes are this share apart.
fn apart(ranked: Vec<(f64, AddedEffect)>, share: f64) -> Vec<(f64, AddedEffect)> {
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

/// Sigmas beyond which a residual counts no more.
const BOUND: f64 = 3.0;

/// Sizes on either side of a hint that the telling runs have to tell apart, in the hint's.
const TOLD_APART: [f64; 2] = [0.9, 1.1];

/// Samples of runs that are enough to tell sizes apart.
const ENOUGH: usize = 1200;

/// The loss of a residual, of whose size nothing counts beyond [`BOUND`]: the noise of the current decides here and
/// there whether a spool jumps, and what comes after a jump that was missed must not outweigh all others.
fn bounded_loss(residual: f64) -> f64 {
    (residual * residual).min(BOUND * BOUND)
}

/// Loss by which two sizes of the effect differ in each run. One that it changes much, but by any size alike, like a
/// plateau that is reached from below, leaves them all in question.
fn changed(experiment: &Experiment, model: &Model, base: &Fit, hint: &AddedEffect) -> Vec<f64> {
    let [smaller, larger] = TOLD_APART.map(|share| {
        let mut with = base.estimate.clone();
        with.effects.push(scaled(hint, share));
        residuals(experiment, model, &base.weights, &with)
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

/// The geometric mean of two losses in each run: what differs by the size tells nothing where nothing is missing.
fn both(one: &[f64], other: &[f64]) -> Vec<f64> {
    let runs = one.iter().zip(other);
    runs.map(|(one, other)| (one * other).sqrt()).collect()
}

/// Runs that tell enough, as many of lifting as of lowering if there are runs of the one and of the other, the most
/// telling ones first: what else is missing may spoil the runs of one valve.
fn of_each_valve(experiment: &Experiment, told: &[f64]) -> Vec<usize> {
    let [mut lifting, mut lowering] = [
        [Regime::Lifting, Regime::Lowering],
        [Regime::Lowering, Regime::Lifting],
    ]
    .map(|[wanted, other]| {
        let alone = |run: &ReadyRun| run.regimes.contains(&wanted) && !run.regimes.contains(&other);
        let told = experiment.runs.iter().zip(told);
        let told = told.map(|(run, &told)| if alone(run) { told } else { 0.0 });
        enough(experiment, &told.collect::<Vec<_>>(), ENOUGH / 2).into_iter()
    });
    if lifting.len().min(lowering.len()) == 0 {
        return enough(experiment, told, ENOUGH);
    }
    let pairs = std::iter::from_fn(|| {
        let pair = [lowering.next(), lifting.next()];
        pair.iter().any(Option::is_some).then_some(pair)
    });
    pairs.flatten().flatten().collect()
}

/// Runs with so many samples as are enough, the most telling first for their length, by what each tells.
fn enough(experiment: &Experiment, told: &[f64], enough: usize) -> Vec<usize> {
    let density = |run: usize| told[run] / experiment.runs[run].regimes.len().max(1) as f64;
    let mut runs: Vec<usize> = (0..told.len()).filter(|&run| told[run] > 0.0).collect();
    runs.sort_by(|&a, &b| density(b).total_cmp(&density(a)));
    let mut samples = 0;
    let few = |&run: &usize| {
        let too_few = samples < enough;
        samples += experiment.runs[run].len();
        too_few
    };
    runs.into_iter().take_while(few).collect()
}

/// Every size with every shape, and what makes narrow_valleys.
fn coarse(hint: &AddedEffect, grid: &Grid) -> Vec<AddedEffect> {
    let share = |k: usize| k as f64 / (grid.shapes - 1) as f64;
    let next = |size: f64| match grid.step {
        Step::Share(share) => size * (1.0 + share),
        Step::Even(step) => size + step,
    };
    let even = combinations(hint, |index, range| match index {
        0 => sizes(range, grid.sizes, next),
        1 => (0..grid.shapes)
            .map(|k| range.moved(range.low, share(k)))
            .collect(),
        other => vec![hint.values[other]],
    });
    let narrow_valleys = grid
        .narrow_valleys
        .as_ref()
        .map_or_else(Vec::new, |narrow_valleys| {
            let next = |size: f64| {
                size * (1.0 + (narrow_valleys.finer * size).min(narrow_valleys.coarsest))
            };
            combinations(hint, |index, range| match index {
                0 => sizes(range, narrow_valleys.sizes, next),
                _ => vec![range.high],
            })
        });
    [even, narrow_valleys].concat()
}

/// Sizes from the smallest to the largest, in typical ones, each with the next larger one.
fn sizes(size: &Parameter, [smallest, largest]: [f64; 2], next: impl Fn(f64) -> f64) -> Vec<f64> {
    std::iter::successors(Some(smallest), |&at| Some(next(at)))
        .take_while(|&at| at <= largest)
        .map(|at| size.null + at * (size.typical - size.null))
        .filter(|value| (size.low..=size.high).contains(value))
        .collect()
}

/// Sizes and shapes around others.
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
