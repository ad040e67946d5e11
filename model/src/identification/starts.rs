//! Where the fit of an effect starts: its size and shape looked for along secants.

use super::estimate::Estimate;
use super::experiment::Experiment;
use super::fit::sketch;
use super::jacobian::huber_residuals;
use super::lateness::in_place_of_clocks;
use super::scan::{Grid, JUMPS, PLACES, PLACES_AT_REST, RINGING, scan};
use super::shortlist::{FAR, STARTS, Shortlist};
use crate::campaign::Channel;
use crate::effects::{AddedEffect, Effect, Parameter, Search};

/// Sizes of the secants, in typical sizes: derivatives at zero miss a play or a gap, one size misses what saturates.
const SIZES: [f64; 3] = [0.1, 1.0, 4.0];

/// Sizes that differ by less than this share of the larger are one start.
const SAME_VALLEY: f64 = 0.08;

/// Most promises of secants that are put to the test at a time.
const MOST_PROMISES: usize = 4;

/// A change of cost that is no more than this is none.
const NOTHING: f64 = 1.0;

/// Sections of a search between a promise and the end of its secant.
const SECTIONS: usize = 6;

/// How far a secant is trusted, in its own size.
const REACH: f64 = 8.0;

/// Where the fit of an effect may start.
pub(super) struct Starts {
    pub effect: &'static dyn Effect,
    /// Least cost that is left once all else has adapted.
    pub cost: f64,
    /// The most promising, at least one, the best first.
    pub ranked: Vec<Start>,
    /// Whether each lies in a valley of its own that was found in fine steps.
    pub looked_through: bool,
}

/// A start and the cost that it leaves once all else has adapted.
pub(super) struct Start {
    pub cost: f64,
    pub estimate: Estimate,
    /// How many times its size away the secant ends that promises the cost; `None` if the cost was simulated.
    promised_from: Option<f64>,
}

/// The end of a secant: an effect simulated at one size.
struct SecantEnd {
    residuals: Vec<Vec<f64>>,
    start: Start,
}

impl Start {
    /// The effect that it starts.
    fn last(&self) -> AddedEffect {
        let last = self.estimate.effects.last();
        last.expect("a start has its effect last").clone()
    }
}

impl Shortlist<'_> {
    /// Starts of an effect that a few secants lead to.
    pub(super) fn starts(&self, effect: &'static dyn Effect) -> Starts {
        let ends = self.ends(sizes(effect));
        let late = self.late(&ends);
        let mut ranked = self.rank(ends);
        ranked.extend(late);
        ranked.extend(self.rank(self.ends(with_opposite_shapes(effect))));
        ranked.extend(self.in_place_of_clocks(effect));
        self.sort(&mut ranked);
        self.best_starts(effect, ranked, false)
    }

    /// The best size of an effect that begins between two of the sizes, like the ground under a hitch that is never
    /// lowered to the end: the smaller is nothing, and the larger so much that no secant of it leads back.
    fn late(&self, ends: &[SecantEnd]) -> Option<Start> {
        let shows = |end: &SecantEnd| (end.start.cost - self.base.cost).abs() > self.worthwhile;
        let begun = ends.iter().position(shows)?;
        let (nothing, begun) = (&ends[begun.checked_sub(1)?].start, &ends[begun].start);
        if self.base.cost - begun.cost > self.worthwhile {
            return None;
        }
        let (smaller, larger) = (nothing.last(), begun.last());
        let null = larger.effect.parameters()[0].null;
        let smaller = (smaller.values[0] - null) / (larger.values[0] - null);
        Some(golden_section(
            |share| self.end(scaled(&larger, share)).start,
            smaller,
            1.0,
        ))
    }

    /// A lag in place of the clocks that stand in for it.
    fn in_place_of_clocks(&self, effect: &'static dyn Effect) -> Option<Start> {
        let start = in_place_of_clocks(&self.base.estimate, effect)?;
        let (experiment, weights) = (self.experiment, &self.base.weights);
        let found = sketch(experiment, self.model, weights, start, true);
        Some(Start {
            cost: found.cost,
            estimate: found.estimate,
            promised_from: None,
        })
    }

    /// Starts of an effect in the valleys that fine steps find.
    pub(super) fn looked_through(&self, effect: &'static dyn Effect, grid: &Grid) -> Starts {
        let mut ranked = self.rank(self.ends(sizes(effect)));
        if let Some(first) = ranked.first() {
            let hint = first.last();
            let scan = || scan(self.experiment, self.model, self.base, &hint, grid);
            let found = self.scans.of(effect, self.base.cost, scan);
            ranked.extend(self.rank(self.ends(found)));
            self.sort(&mut ranked);
        }
        self.best_starts(effect, ranked, true)
    }

    /// The best of ranked starts, after a look at the extreme shapes of the best one.
    fn best_starts(
        &self,
        effect: &'static dyn Effect,
        mut ranked: Vec<Start>,
        looked_through: bool,
    ) -> Starts {
        if let Some(best) = self.promising(&ranked) {
            ranked.extend(self.rank(self.ends(with_extreme_shapes(&best))));
            self.sort(&mut ranked);
        }
        let cost = ranked.first().map_or(self.base.cost, |first| first.cost);
        let mut valleys: Vec<Start> = Vec::new();
        for start in ranked {
            let known = |other: &Start| !apart(&other.estimate, &start.estimate);
            if valleys.len() < STARTS && !valleys.iter().any(known) {
                valleys.push(start);
            }
        }
        Starts {
            effect,
            cost,
            ranked: valleys,
            looked_through,
        }
    }

    /// Of every secant its end and the best point along it: the one is sure, the other may be far better. Best first.
    fn rank(&self, ends: Vec<SecantEnd>) -> Vec<Start> {
        let mut ranked: Vec<Start> = ends
            .into_iter()
            .flat_map(|SecantEnd { residuals, start }| {
                let added = start.last();
                let (lowest, highest) = reach(&added);
                let (share, cost) = self.frame.along(&residuals, lowest, highest);
                // The best of a secant that leads away from the data is nothing at all.
                let promised = (share != 0.0).then(|| Start {
                    cost,
                    estimate: with(&self.base.estimate, scaled(&added, share)),
                    promised_from: Some(1.0 / share),
                });
                promised.into_iter().chain([start])
            })
            .collect();
        self.sort(&mut ranked);
        ranked
    }

    /// Sorts starts, and has the best one simulated until that is no promise.
    fn sort(&self, ranked: &mut [Start]) {
        for _ in 0..MOST_PROMISES {
            ranked.sort_by(|a, b| a.cost.total_cmp(&b.cost));
            match ranked.first_mut() {
                Some(first) if self.base.cost - first.cost > self.worthwhile => {
                    match first.promised_from {
                        Some(end) => *first = self.kept(first, end),
                        None => return,
                    }
                }
                _ => return,
            }
        }
        ranked.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    }

    /// What becomes of a promise. A secant that begins with nothing, like the slip of a pump that has flow to spare,
    /// promises what is not there yet; then the size is looked for on the way to the secant's `end`.
    fn kept(&self, promise: &Start, end: f64) -> Start {
        let size = promise.last();
        let start = self.end(size.clone()).start;
        if end <= 1.0 || !self.is_nothing(&start) {
            return start;
        }
        let start_at = |share: f64| self.end(scaled(&size, share)).start;
        golden_section(start_at, 1.0, end)
    }

    /// Whether a start is as good as none. Near the data, what is free may move on a little beside it; far from them
    /// the frame promises more than it could keep.
    fn is_nothing(&self, start: &Start) -> bool {
        let near = |cost: f64| (cost - start.cost).abs() <= NOTHING;
        near(self.base.cost) || (self.base.error() <= FAR && near(self.frame.here()))
    }

    /// The best start's effect if it explains enough to be worth a closer look.
    fn promising(&self, ranked: &[Start]) -> Option<AddedEffect> {
        let first = ranked.first()?;
        (self.base.cost - first.cost > self.worthwhile).then(|| first.last())
    }

    fn ends(&self, added: Vec<AddedEffect>) -> Vec<SecantEnd> {
        added.into_iter().map(|added| self.end(added)).collect()
    }

    /// An added effect simulated.
    fn end(&self, added: AddedEffect) -> SecantEnd {
        let estimate = with(&self.base.estimate, added);
        let residuals = huber_residuals(self.experiment, self.model, &self.base.weights, &estimate);
        let start = Start {
            cost: self.frame.cost_after(&residuals),
            estimate,
            promised_from: None,
        };
        SecantEnd { residuals, start }
    }
}

/// The best of some starts between two sizes: a golden section search.
fn golden_section(start_at: impl Fn(f64) -> Start, mut low: f64, mut high: f64) -> Start {
    let inner = 0.5 * (5f64.sqrt() - 1.0);
    let between = |from: f64, to: f64| from + inner * (to - from);
    let (mut left, mut right) = (start_at(between(high, low)), start_at(between(low, high)));
    for _ in 0..SECTIONS {
        if left.cost < right.cost {
            high = between(low, high);
            right = left;
            left = start_at(between(high, low));
        } else {
            low = between(high, low);
            left = right;
            right = start_at(between(low, high));
        }
    }
    if left.cost < right.cost { left } else { right }
}

/// An effect at a multiple of its size.
pub(super) fn scaled(added: &AddedEffect, share: f64) -> AddedEffect {
    let null = added.effect.parameters()[0].null;
    let mut scaled = added.clone();
    scaled.values[0] = null + share * (scaled.values[0] - null);
    scaled
}

/// Whether the last effects of two estimates are sizes that lead to different valleys.
fn apart(a: &Estimate, b: &Estimate) -> bool {
    let last = |estimate: &Estimate| estimate.effects.last().map(|added| added.values.clone());
    let (Some(a), Some(b)) = (last(a), last(b)) else {
        return true;
    };
    let alike = |x: f64, y: f64| (x - y).abs() <= SAME_VALLEY * x.abs().max(y.abs());
    !(alike(a[0], b[0]) && a[1..] == b[1..])
}

fn with(estimate: &Estimate, added: AddedEffect) -> Estimate {
    let mut with = estimate.clone();
    with.effects.push(added);
    with
}

/// How to look through an effect's cost if that has many valleys: the phase of a ringing pressure makes them, and what
/// jumps or bounces.
pub(super) fn valleys(experiment: &Experiment, effect: &dyn Effect) -> Option<&'static Grid> {
    let pressure_alone = effect.channels() == [Channel::CylinderPressure];
    match effect.search() {
        Search::Jumps => Some(&JUMPS),
        Search::Places if experiment.ringing => Some(&PLACES),
        Search::Places => Some(&PLACES_AT_REST),
        Search::Secants if experiment.ringing && pressure_alone => Some(&RINGING),
        Search::Secants | Search::Ledges => None,
    }
}

/// An effect at the sizes of the secants.
fn sizes(effect: &'static dyn Effect) -> Vec<AddedEffect> {
    let size = &effect.parameters()[0];
    SIZES
        .iter()
        .map(|&s| scaled(&AddedEffect::typical(effect), s))
        .filter(|added| (size.low..=size.high).contains(&added.values[0]))
        .collect()
}

/// An effect at its typical size with each parameter of its shape that may have either sign at both ends of its range:
/// an arm that grows over the stroke and one that is there all over it have nothing in common, and where one is hidden
/// no secant of the other leads anywhere.
fn with_opposite_shapes(effect: &'static dyn Effect) -> Vec<AddedEffect> {
    let typical = AddedEffect::typical(effect);
    with_shapes(&typical, |shape| shape.low < 0.0 && shape.high > 0.0)
}

/// Smallest and largest multiple of an effect's size that its range and the trust in a secant allow.
fn reach(added: &AddedEffect) -> (f64, f64) {
    let range = &added.effect.parameters()[0];
    let size = added.values[0] - range.null;
    let ends = [range.low, range.high].map(|end| (end - range.null) / size);
    (
        ends[0].min(ends[1]).max(-REACH),
        ends[0].max(ends[1]).min(REACH),
    )
}

/// An effect with each parameter of its shape towards either end of its range in turn; none without a shape.
pub(super) fn with_extreme_shapes(at: &AddedEffect) -> Vec<AddedEffect> {
    with_shapes(at, |_| true)
}

/// [`with_extreme_shapes`] of those parameters that are `chosen`.
fn with_shapes(at: &AddedEffect, chosen: impl Fn(&Parameter) -> bool) -> Vec<AddedEffect> {
    let parameters = at.effect.parameters().iter().enumerate().skip(1);
    parameters
        .filter(|(_, range)| chosen(range))
        .flat_map(|(index, range)| {
            let ends = [range.low, range.high].into_iter();
            ends.filter(|end| end.is_finite()).map(move |end| {
                let mut added = at.clone();
                added.values[index] = extreme(range, end);
                added
            })
        })
        .collect()
}

/// A value as extreme as is of use for a start: the end of the range, unless that is an order of magnitude away.
/// There, where the ground is all but rigid, the slopes vanish that would lead back.
fn extreme(range: &Parameter, end: f64) -> f64 {
    if range.is_by_magnitude() {
        (range.typical * end).sqrt()
    } else {
        end
    }
}
