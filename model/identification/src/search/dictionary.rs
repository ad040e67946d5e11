//! The dictionary: candidate changes of a model, each simulated around a fit as a column.

use hitch_plant::{AddedEffect, Effect, SizeResponse};

use crate::data::limit::Limit;
use crate::data::problem::Problem;
use crate::estimate::{Estimate, Shared};
use crate::estimation::gram::Gram;
use crate::estimation::jacobian::Jacobian;
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::residual_columns::{difference, huber, subtract};
use crate::parallel;
use crate::search::best_subset::Subset;
use crate::search::candidates::possible;
use crate::search::coarse_view::Coarse;
use crate::search::dictionary_entry::{Entry, Kind};
use crate::search::screening::Screen;
use crate::search::secant_ends::LARGEST_SHARE;
use crate::search::shape_starts::scaled;
use crate::selection::candidate::{jacobian_by, slow_columns};

/// Sizes of a changed adopted effect: increments as shares of its own size and of its typical size.
const CHANGES: [(f64, f64); 4] = [(-0.5, 0.0), (-1.0, 0.0), (0.5, 0.25), (1.5, 1.0)];

/// Sizes of another form that acts in addition to the present one, in typical sizes.
const SMALL_SIZES: [f64; 3] = [0.1, 0.3, 1.0];

/// Largest share of the secant to a changed size.
const LARGEST_CHANGE: f64 = 1.5;

/// Columns of candidate effects and changes of a fitted model.
pub(crate) struct Dictionary {
    /// The columns.
    pub entries: Vec<Entry>,
    /// Gram matrix of the columns, nuisance parameters projected out, around the model without any of them.
    pub gram: Gram,
    /// Whether it includes the results of fine scans for effects whose cost has many local minima.
    pub is_thorough: bool,
    /// Residuals without any of the columns.
    without: Vec<Vec<f64>>,
    /// Sensitivities to the nuisance parameters, at the fit in the centre.
    pub jacobian: Jacobian,
    estimate: Estimate,
}

impl Dictionary {
    fn new(
        entries: Vec<Entry>,
        without: Vec<Vec<f64>>,
        jacobian: Jacobian,
        estimate: &Estimate,
    ) -> Self {
        let nuisances = nuisances(&jacobian);
        let changes: Vec<&[Vec<f64>]> = entries.iter().map(|entry| &*entry.change).collect();
        let residuals: Vec<&[f64]> = without.iter().map(Vec::as_slice).collect();
        let eliminated = (nuisances.as_slice(), nuisances.len());
        let gram = jacobian.gram(estimate, eliminated, &changes, &residuals);
        Self {
            entries,
            gram,
            is_thorough: false,
            without,
            jacobian,
            estimate: estimate.clone(),
        }
    }

    /// Whether the size of a column is suitable as the start of a fit. Switching and located effects need a size from a
    /// fine scan.
    pub fn is_start(&self, column: usize) -> bool {
        let entry = &self.entries[column];
        let search = entry.added.effect.size_response();
        let is_sought = matches!(search, SizeResponse::Switching | SizeResponse::Located);
        self.is_thorough || entry.kind != Kind::New || !is_sought
    }

    /// Residuals of a subset to first order, with all nuisance parameters re-optimised.
    pub fn left(&self, subset: &Subset) -> Vec<Vec<f64>> {
        let mut left = self.without.clone();
        for (&column, &share) in subset.columns.iter().zip(&subset.shares) {
            for (left, change) in left.iter_mut().zip(&self.entries[column].change) {
                subtract(left, share, change);
            }
        }
        NuisanceProjection::new(&self.jacobian, &self.estimate, 0..0).project(left)
    }
}

/// The inputs of a dictionary.
pub(crate) struct DictionaryBuilder<'a> {
    pub coarse: &'a Coarse<'a>,
    /// Effects that are searched for.
    pub effects: Vec<&'static dyn Effect>,
    /// Whether the sizes of adopted effects may change.
    pub changes: bool,
    /// Smallest predicted reduction of the cost for which an effect is examined more closely.
    pub worthwhile: f64,
    /// Until when columns are simulated; then the dictionary has those so far.
    pub limit: Limit<'a>,
}

impl DictionaryBuilder<'_> {
    /// The dictionary around a fit.
    pub fn dictionary(&self) -> Dictionary {
        let (problem, seen) = (self.coarse.condensed(), &self.coarse.seen);
        let slow = slow_columns(problem, seen);
        let jacobian = jacobian_by(problem, seen, &slow);
        let here = huber(seen.residuals.clone());
        let fine = self.screen(problem, &jacobian, &here);
        let own = self.own(&fine);
        let mut without = here.clone();
        for entry in &own {
            add(&mut without, &entry.change);
        }
        let rough = self.screen(self.coarse.with_coarse_steps(), &jacobian, &here);
        let new = rough.columns(self.effects.clone());
        let forms = self.other_forms(&fine, &own);
        let changed = if self.changes {
            self.changed(&rough)
        } else {
            Vec::new()
        };
        drop((fine, rough));
        let entries = own.into_iter().chain(forms).chain(new).chain(changed);
        Dictionary::new(entries.collect(), without, jacobian, &seen.estimate)
    }

    /// A dictionary extended by fine scans for effects whose cost has many local minima.
    pub fn thorough(&self, dictionary: Dictionary) -> Dictionary {
        let seen = &self.coarse.seen;
        let Dictionary {
            entries,
            without,
            jacobian,
            ..
        } = dictionary;
        let here = huber(seen.residuals.clone());
        let entries = self
            .screen(self.coarse.with_coarse_steps(), &jacobian, &here)
            .fine_columns(entries);
        Dictionary {
            is_thorough: true,
            ..Dictionary::new(entries, without, jacobian, &seen.estimate)
        }
    }

    fn screen<'s>(
        &'s self,
        problem: Problem<'s>,
        jacobian: &'s Jacobian,
        here: &'s [Vec<f64>],
    ) -> Screen<'s> {
        Screen {
            problem: problem.within(self.limit),
            coarse: self.coarse,
            worthwhile: self.worthwhile,
            here,
            projection: NuisanceProjection::new(jacobian, &self.coarse.seen.estimate, 0..0),
        }
    }

    /// Columns of the effects that the search has added or changed, from absent to their present sizes: removing one is
    /// simulated exactly.
    fn own(&self, screen: &Screen) -> Vec<Entry> {
        let estimate = &self.coarse.present.estimate;
        let indices = 0..estimate.effects.len();
        let column = |index: usize| Entry {
            kind: Kind::Present(index),
            off: estimate.off(index),
            change: difference(&screen.residuals(&estimate.without(index)), screen.here),
            share: (0.0, LARGEST_SHARE),
            added: estimate.effects[index].clone(),
        };
        parallel::map(
            indices.filter(|&index| !estimate.is_unchanged(index)),
            column,
        )
    }

    /// Columns of the effects that the search has added, in their other forms.
    fn other_forms(&self, screen: &Screen, own: &[Entry]) -> Vec<Entry> {
        let estimate = &self.coarse.present.estimate;
        let added = own.iter().filter_map(|entry| match entry.kind {
            Kind::Present(index) if estimate.adopted_as(entry.id()).is_none() => {
                Some((index, entry))
            }
            _ => None,
        });
        let forms = added.flat_map(|(index, entry)| {
            let other = |form: &&'static dyn Effect| {
                form.id() == entry.id() && form.form() != entry.added.effect.form()
            };
            let forms = possible(self.coarse.problem.model).filter(other);
            let forms = forms.flat_map(|form| in_form(&entry.added, form));
            forms.map(move |added| (index, entry, added))
        });
        let column = |(index, entry, added): (usize, &Entry, AddedEffect)| {
            let form = added.effect;
            let mut other = estimate.clone();
            other.effects[index] = added.clone();
            let mut change = difference(screen.here, &screen.residuals(&other));
            add(&mut change, &entry.change);
            Entry {
                kind: Kind::New,
                off: form.parameters()[0].null,
                change,
                share: (0.0, LARGEST_SHARE),
                added,
            }
        };
        parallel::map(forms, column)
    }

    /// Columns of unchanged adopted effects, at other sizes.
    fn changed(&self, screen: &Screen) -> Vec<Entry> {
        let estimate = &self.coarse.present.estimate;
        let indices = 0..estimate.effects.len();
        let goes_on = !screen.problem.limit.is_over();
        let unchanged = indices.filter(|&index| goes_on && estimate.is_unchanged(index));
        let sizes = unchanged.flat_map(|index| {
            let sizes = changed_sizes(&estimate.effects[index]).into_iter();
            sizes.map(move |size| (index, size))
        });
        let column = |(index, size): (usize, f64)| {
            let mut other = estimate.clone();
            let off = other.effects[index].values[0];
            other.effects[index].values[0] = size;
            Entry {
                kind: Kind::Change(index),
                off,
                change: difference(screen.here, &screen.residuals(&other)),
                share: (0.0, LARGEST_CHANGE),
                added: other.effects[index].clone(),
            }
        };
        parallel::map(sizes, column)
    }
}

/// An effect in another form. If the size parameter of that form is not a parameter of the present form, it acts in
/// addition to the present effect. Small sizes are then included as well: the secant to the full size does not predict
/// them.
fn in_form(added: &AddedEffect, form: &'static dyn Effect) -> Vec<AddedEffect> {
    let other = added.in_form(form);
    let size = &form.parameters()[0];
    let mut own = added.effect.parameters().iter();
    if own.any(|parameter| parameter.name == size.name) {
        vec![other]
    } else {
        SMALL_SIZES.map(|share| scaled(&other, share)).to_vec()
    }
}

/// Sizes to which an adopted effect is changed, within its range.
fn changed_sizes(adopted: &AddedEffect) -> Vec<f64> {
    let range = &adopted.effect.parameters()[0];
    let own = adopted.values[0] - range.null;
    let typical = range.scale().copysign(own);
    let size = |(of_own, of_typical): &(f64, f64)| {
        let size = adopted.values[0] + of_own * own + of_typical * typical;
        size.clamp(range.low, range.high)
    };
    let mut sizes: Vec<f64> = CHANGES.iter().map(size).collect();
    sizes.retain(|&size| size != adopted.values[0]);
    sizes.dedup();
    sizes
}

/// Columns of the nuisance parameters: clocks, and the shape parameters of present effects.
fn nuisances(jacobian: &Jacobian) -> Vec<usize> {
    let adapts = |shared: &Shared| !matches!(shared, Shared::Effect(_, 0));
    let columns = jacobian.shared.iter().enumerate();
    columns
        .filter(|(_, shared)| adapts(shared))
        .map(|(column, _)| column)
        .collect()
}

/// Adds `others` to `columns`.
fn add(columns: &mut [Vec<f64>], others: &[Vec<f64>]) {
    for (column, other) in columns.iter_mut().zip(others) {
        subtract(column, -1.0, other);
    }
}
