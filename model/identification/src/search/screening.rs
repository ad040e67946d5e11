//! Screening of single effects that a model lacks.
//!
//! A secant at one size misses effects that saturate, switch or have a threshold, so each form is simulated at two
//! sizes or more. The forms with the best predictions are also simulated where their secants lead, at the ends of their
//! shape ranges, and at the results of a fine scan if requested.

use hitch_plant::{AddedEffect, Effect, SizeResponse, is_same};

use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::jacobian::Jacobian;
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::residual_columns::{difference, huber_residuals};
use crate::parallel;
use crate::search::coarse_view::Coarse;
use crate::search::dictionary_entry::{Entry, Kind};
use crate::search::secant_ends::{End, best, columns, trusted};
use crate::search::shape_starts::{scaled, scan_grid, with_extreme_shapes, with_opposite_shapes};
use crate::search::size_scan::scan;

/// Sizes of the first secants, in typical sizes: of smooth effects, and of all others.
const SMOOTH: &[f64] = &[0.3, 2.0];
const ROUGH: &[f64] = &[0.3, 1.0, 2.0];

/// Sizes of the opposite sign, in typical sizes, of effects of either sign: if edges of a signal move, the secant at
/// half the size predicts little.
const OPPOSITE: &[f64] = &[-0.3, -1.0];

/// Share of the best predicted cost reduction above which a form is examined closely.
const PROMISING: f64 = 0.2;

/// Largest number of secant predictions that are simulated one after the other, smallest distance of one from a
/// simulated end, as a share, and smallest predicted reduction, as a share of `worthwhile`.
const PREDICTIONS: usize = 4;
const MOVED: f64 = 0.1;
const GAIN: f64 = 0.2;

/// Sections of the golden section search for the size of an effect with a threshold.
const SECTIONS: usize = 5;

/// Root mean square error above which a model leaves enough for a fine scan for effects that secants do not show.
pub(crate) const EXPLAINED: f64 = 1.05;

/// Screening of single effects around a fit.
pub(crate) struct Screen<'a> {
    /// The experiment for simulations, the condensed one or its version with coarse time steps, and the model.
    pub problem: Problem<'a>,
    pub coarse: &'a Coarse<'a>,
    /// Smallest predicted reduction of the cost for which an effect is examined closely.
    pub worthwhile: f64,
    /// The present residuals, after Huber's loss.
    pub here: &'a [Vec<f64>],
    /// Projection of the free parameters of the present fit.
    pub projection: NuisanceProjection<&'a Jacobian>,
}

impl Screen<'_> {
    /// The columns of effects that the model lacks.
    pub fn columns(&self, effects: Vec<&'static dyn Effect>) -> Vec<Entry> {
        let forms = parallel::map(effects, |effect| {
            (!self.problem.limit.is_over()).then(|| self.at_first_sizes(effect))
        });
        let mut forms: Vec<Vec<End>> = forms.into_iter().flatten().collect();
        let here = self.cost();
        let predicted: Vec<f64> = parallel::map(&forms, |ends| self.predicted(ends));
        let least = predicted.iter().copied().fold(here, f64::min);
        let worthwhile = (PROMISING * (here - least)).max(self.worthwhile);
        parallel::map(forms.iter_mut().zip(&predicted), |(ends, predicted)| {
            if here - predicted > worthwhile && !self.problem.limit.is_over() {
                self.examine(ends);
            }
        });
        let columns = |ends: Vec<End>| columns(ends, self.here);
        forms.into_iter().flat_map(columns).collect()
    }

    /// The columns, with the results of fine scans for effects whose cost has many local minima.
    pub fn fine_columns(&self, entries: Vec<Entry>) -> Vec<Entry> {
        let has_local_minima = |entry: &Entry| {
            let effect = entry.added.effect;
            entry.kind == Kind::New && scan_grid(self.coarse.problem.experiment, effect).is_some()
        };
        let (searched, mut entries): (Vec<Entry>, Vec<Entry>) =
            entries.into_iter().partition(has_local_minima);
        let mut forms: Vec<Vec<End>> = Vec::new();
        for entry in &searched {
            let end = self.end_of(entry);
            let same = |ends: &&mut Vec<End>| is_same(ends[0].added.effect, end.added.effect);
            match forms.iter_mut().find(same) {
                Some(form) => form.push(end),
                None => forms.push(vec![end]),
            }
        }
        let scanned = parallel::map(forms, |mut ends| {
            let promising = self.cost() - self.predicted(&ends) > self.worthwhile;
            if !self.problem.limit.is_over() {
                self.fine_scan(&mut ends, promising);
            }
            columns(ends, self.here)
        });
        entries.extend(scanned.into_iter().flatten());
        entries
    }

    /// The end of a column's secant.
    fn end_of(&self, entry: &Entry) -> End {
        let residuals = difference(self.here, &entry.change);
        End {
            cost: self.projection.cost_after(&residuals),
            added: entry.added.clone(),
            residuals,
            first: true,
        }
    }

    /// The cost without any effect, with the free parameters re-optimised.
    fn cost(&self) -> f64 {
        self.coarse.seen.cost.min(self.projection.here())
    }

    /// The least cost that the secants of a form predict.
    fn predicted(&self, ends: &[End]) -> f64 {
        let of_end = |index: usize| {
            let (low, high) = trusted(ends, index);
            let along = self.projection.along(&ends[index].residuals, low, high);
            along.1.min(ends[index].cost)
        };
        (0..ends.len()).map(of_end).fold(f64::INFINITY, f64::min)
    }

    /// A form at its first sizes.
    fn at_first_sizes(&self, effect: &'static dyn Effect) -> Vec<End> {
        let range = &effect.parameters()[0];
        let typical = AddedEffect::typical(effect);
        let sizes = match effect.size_response() {
            SizeResponse::Smooth => SMOOTH,
            SizeResponse::Switching | SizeResponse::Stepped | SizeResponse::Located => ROUGH,
        };
        let at = |sizes: &[f64]| {
            let sizes = sizes.iter().map(|&share| scaled(&typical, share));
            let within = |added: &AddedEffect| (range.low..=range.high).contains(&added.values[0]);
            self.ends(sizes.filter(within).collect(), true)
        };
        let mut ends = at(sizes);
        self.find_threshold(&mut ends);
        ends.extend(at(OPPOSITE));
        ends.extend(self.ends(with_opposite_shapes(effect), false));
        ends
    }

    /// Further ends of a form: where its secants lead, and the ends of its shape ranges.
    fn examine(&self, ends: &mut Vec<End>) {
        self.follow(ends);
        if let Some(best) = best(ends) {
            let shapes = with_extreme_shapes(&best.added);
            ends.extend(self.ends(shapes, false));
            self.follow(ends);
        }
    }

    /// Further ends of a form from a fine scan, if its cost has many local minima.
    fn fine_scan(&self, ends: &mut Vec<End>, promising: bool) {
        let Some(hint) = best(ends).map(|best| best.added.clone()) else {
            return;
        };
        let Coarse {
            problem, present, ..
        } = self.coarse;
        let experiment = problem.experiment;
        let is_unexplained = present.error() > EXPLAINED;
        if let Some(grid) = scan_grid(experiment, hint.effect)
            && (promising || (is_unexplained && !grid.hinted))
        {
            // Condensed runs do not show when a spool jumps; runs with coarse time steps do show the ringing of a
            // pressure.
            let runs = if experiment.ringing {
                self.problem
            } else {
                *problem
            };
            ends.extend(self.ends(scan(runs, present, &hint, grid), false));
        }
    }

    /// Golden section search between a size without any change and the next larger one, which overshoots: no secant
    /// predicts the best size of an effect with a threshold, like the slip of a pump with excess flow.
    fn find_threshold(&self, ends: &mut Vec<End>) {
        let does = |end: &End| (end.cost - self.coarse.seen.cost).abs() > self.worthwhile;
        let Some(first_change) = ends
            .iter()
            .position(does)
            .filter(|&first_change| first_change > 0)
        else {
            return;
        };
        if self.cost() - ends[first_change].cost > self.worthwhile {
            return;
        }
        let (nothing, much) = (
            &ends[first_change - 1].added,
            ends[first_change].added.clone(),
        );
        let null = much.effect.parameters()[0].null;
        let (mut low, mut high) = ((nothing.values[0] - null) / (much.values[0] - null), 1.0);
        let inner = 0.5 * (5f64.sqrt() - 1.0);
        let at = |share: f64| self.end(scaled(&much, share), false);
        let between = |from: f64, to: f64| from + inner * (to - from);
        let mut left = at(between(high, low));
        let mut right = at(between(low, high));
        for _ in 0..SECTIONS {
            if left.cost < right.cost {
                high = between(low, high);
                right = left;
                left = at(between(high, low));
            } else {
                low = between(high, low);
                left = right;
                right = at(between(low, high));
            }
        }
        ends.extend([left, right]);
    }

    /// Simulates the best prediction of the secants, repeatedly, until none improves.
    ///
    /// A secant is trusted up to the geometric mean of its end and the next simulated size.
    fn follow(&self, ends: &mut Vec<End>) {
        for _ in 0..PREDICTIONS {
            let least = ends.iter().map(|end| end.cost).fold(self.cost(), f64::min);
            let predictions = (0..ends.len()).filter_map(|index| {
                let (low, high) = trusted(ends, index);
                let end = &ends[index];
                let (share, cost) = self.projection.along(&end.residuals, low, high);
                let moved = (share - 1.0).abs() > MOVED && share != 0.0;
                moved.then(|| (cost, scaled(&end.added, share)))
            });
            let Some((cost, predicted)) = predictions.min_by(|a, b| a.0.total_cmp(&b.0)) else {
                return;
            };
            if least - cost < GAIN * self.worthwhile || predicted.is_null() {
                return;
            }
            ends.push(self.end(predicted, false));
        }
    }

    fn ends(&self, added: Vec<AddedEffect>, first: bool) -> Vec<End> {
        parallel::map(added, |added| self.end(added, first))
    }

    fn end(&self, added: AddedEffect, first: bool) -> End {
        let mut estimate = self.coarse.present.estimate.clone();
        estimate.effects.push(added.clone());
        let residuals = self.residuals(&estimate);
        End {
            cost: self.projection.cost_after(&residuals),
            added,
            residuals,
            first,
        }
    }

    /// Residuals of an estimate after Huber's loss, under the present weights.
    pub fn residuals(&self, estimate: &Estimate) -> Vec<Vec<f64>> {
        huber_residuals(self.problem, &self.coarse.seen.weights, estimate)
    }
}
