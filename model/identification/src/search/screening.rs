//! What effects that a model does not have would change, each looked for by itself.
//!
//! A secant at one size misses what saturates, jumps, or begins late, so each form of an effect is simulated at two
//! sizes, and those that promise most also where their secants lead, at the ends of their shapes, and where a fine
//! search finds a valley if one is asked for.

use hitch_plant::{AddedEffect, Effect, SizeResponse, is_same};
use rayon::prelude::*;

use crate::data::experiment::Experiment;
use crate::estimate::Estimate;
use crate::estimation::jacobian::{Jacobian, difference, huber_residuals};
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::search::coarse_view::Coarse;
use crate::search::dictionary_entry::{Entry, Kind};
use crate::search::scan_cache::Scans;
use crate::search::secant_ends::{End, best, columns, trusted};
use crate::search::shape_starts::{scaled, valleys, with_extreme_shapes, with_opposite_shapes};
use crate::search::size_scan::scan;

/// Sizes of the first secants, in typical sizes: of an effect along whose size the cost falls smoothly, and of one that
/// jumps or is met at a place.
const SMOOTH: &[f64] = &[0.3, 2.0];
const ROUGH: &[f64] = &[0.3, 1.0, 2.0];

/// Sizes of the other sign, in typical sizes, of an effect that may have either: where edges of a signal move, a secant
/// promises little at half its size.
const OPPOSITE: &[f64] = &[-0.3, -1.0];

/// A form is looked at closely if it promises at least this share of what the best one does.
const PROMISING: f64 = 0.2;

/// Promises of secants that are simulated one after the other, how far from a simulated end one is, as a share, and
/// what it has to promise, as a share of what is worthwhile.
const PROMISES: usize = 4;
const MOVED: f64 = 0.1;
const GAIN: f64 = 0.2;

/// Sections of the search for the size of what begins late.
const SECTIONS: usize = 5;

/// Error above which a model leaves enough for a fine search for what secants see nothing of.
pub(crate) const EXPLAINED: f64 = 1.05;

/// Effects looked for one by one.
pub(crate) struct Screen<'a> {
    /// The experiment that effects are simulated on: the condensed one, or its drafts.
    pub experiment: &'a Experiment,
    pub coarse: &'a Coarse<'a>,
    pub scans: &'a Scans,
    /// Fall of the cost that an effect has to promise to be worth a closer look.
    pub worthwhile: f64,
    /// The present residuals as a fit sees them.
    pub here: &'a [Vec<f64>],
    /// What is free at the present fit, and adapts to an effect.
    pub projection: NuisanceProjection<&'a Jacobian>,
}

impl Screen<'_> {
    /// The columns of effects that the model does not have.
    pub fn columns(&self, effects: Vec<&'static dyn Effect>) -> Vec<Entry> {
        let forms = effects.into_par_iter();
        let mut forms: Vec<Vec<End>> = forms.map(|effect| self.roughly(effect)).collect();
        let here = self.cost();
        let promised: Vec<f64> = forms.par_iter().map(|ends| self.promised(ends)).collect();
        let least = promised.iter().copied().fold(here, f64::min);
        let worthwhile = (PROMISING * (here - least)).max(self.worthwhile);
        let looked_at = forms.par_iter_mut().zip(&promised);
        looked_at.for_each(|(ends, promised)| {
            if here - promised > worthwhile {
                self.closely(ends);
            }
        });
        let columns = |ends: Vec<End>| columns(ends, self.here);
        forms.into_iter().flat_map(columns).collect()
    }

    /// Columns with those that fine searches find of effects whose cost has many valleys.
    pub fn fine_columns(&self, entries: Vec<Entry>) -> Vec<Entry> {
        let has_valleys = |entry: &Entry| {
            let effect = entry.added.effect;
            entry.kind == Kind::New && valleys(self.coarse.experiment, effect).is_some()
        };
        let (searched, mut entries): (Vec<Entry>, Vec<Entry>) =
            entries.into_iter().partition(has_valleys);
        let mut forms: Vec<Vec<End>> = Vec::new();
        for entry in &searched {
            let end = self.end_of(entry);
            let same = |ends: &&mut Vec<End>| is_same(ends[0].added.effect, end.added.effect);
            match forms.iter_mut().find(same) {
                Some(form) => form.push(end),
                None => forms.push(vec![end]),
            }
        }
        let found = forms.into_par_iter().flat_map_iter(|mut ends| {
            let promising = self.cost() - self.promised(&ends) > self.worthwhile;
            self.finely(&mut ends, promising);
            columns(ends, self.here)
        });
        entries.par_extend(found);
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

    /// The cost without any effect, once what is free has adapted.
    fn cost(&self) -> f64 {
        self.coarse.seen.cost.min(self.projection.here())
    }

    /// The least cost that the secants of a form promise.
    fn promised(&self, ends: &[End]) -> f64 {
        let of_end = |index: usize| {
            let (low, high) = trusted(ends, index);
            let along = self.projection.along(&ends[index].residuals, low, high);
            along.1.min(ends[index].cost)
        };
        (0..ends.len()).map(of_end).fold(f64::INFINITY, f64::min)
    }

    /// A form at a few sizes.
    fn roughly(&self, effect: &'static dyn Effect) -> Vec<End> {
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
        self.begin(&mut ends);
        ends.extend(at(OPPOSITE));
        ends.extend(self.ends(with_opposite_shapes(effect), false));
        ends
    }

    /// More ends of a form: where its secants lead, and the ends of its shapes.
    fn closely(&self, ends: &mut Vec<End>) {
        self.follow(ends);
        if let Some(best) = best(ends) {
            let shapes = with_extreme_shapes(&best.added);
            ends.extend(self.ends(shapes, false));
            self.follow(ends);
        }
    }

    /// More ends of a form: what a fine search finds, if its cost has many valleys.
    fn finely(&self, ends: &mut Vec<End>, promising: bool) {
        let Some(hint) = best(ends).map(|best| best.added.clone()) else {
            return;
        };
        let Coarse {
            experiment,
            model,
            present,
            ..
        } = self.coarse;
        let astray = present.error() > EXPLAINED;
        if let Some(grid) = valleys(experiment, hint.effect)
            && (promising || (astray && !grid.hinted))
        {
            // Condensed runs do not show when a spool jumps; drafts show how a pressure rings.
            let runs = match experiment.ringing {
                true => self.experiment,
                false => *experiment,
            };
            let look = || scan(runs, model, present, &hint, grid);
            let found = self.scans.of(hint.effect, present.cost, look);
            ends.extend(self.ends(found, false));
        }
    }

    /// Looks between a size that does nothing and the next larger one, which does too much: no secant leads to the best
    /// size of what begins late, like the slip of a pump with flow to spare (golden section search).
    fn begin(&self, ends: &mut Vec<End>) {
        let does = |end: &End| (end.cost - self.coarse.seen.cost).abs() > self.worthwhile;
        let Some(begun) = ends.iter().position(does).filter(|&begun| begun > 0) else {
            return;
        };
        if self.cost() - ends[begun].cost > self.worthwhile {
            return;
        }
        let (nothing, much) = (&ends[begun - 1].added, ends[begun].added.clone());
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

    /// Simulates what the best secant promises, until that is no promise any more.
    ///
    /// A secant is trusted half way to the sizes that were simulated beside its end.
    fn follow(&self, ends: &mut Vec<End>) {
        for _ in 0..PROMISES {
            let least = ends.iter().map(|end| end.cost).fold(self.cost(), f64::min);
            let promises = (0..ends.len()).filter_map(|index| {
                let (low, high) = trusted(ends, index);
                let end = &ends[index];
                let (share, cost) = self.projection.along(&end.residuals, low, high);
                let moved = (share - 1.0).abs() > MOVED && share != 0.0;
                moved.then(|| (cost, scaled(&end.added, share)))
            });
            let Some((cost, promised)) = promises.min_by(|a, b| a.0.total_cmp(&b.0)) else {
                return;
            };
            if least - cost < GAIN * self.worthwhile || promised.is_null() {
                return;
            }
            ends.push(self.end(promised, false));
        }
    }

    fn ends(&self, added: Vec<AddedEffect>, first: bool) -> Vec<End> {
        let added = added.into_par_iter();
        added.map(|added| self.end(added, first)).collect()
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

    /// Residuals of an estimate as a fit sees them, under the present yardsticks.
    pub fn residuals(&self, estimate: &Estimate) -> Vec<Vec<f64>> {
        let Coarse { model, seen, .. } = self.coarse;
        huber_residuals(self.experiment, model, &seen.weights, estimate)
    }
}
