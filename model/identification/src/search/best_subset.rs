//! Best subsets of the dictionary's columns under the quadratic cost.
//!
//! Subsets of up to [`EXACT`] columns are enumerated. Larger ones are extended from the best [`BEAM`] of one column
//! less: of three columns that explain a campaign, the two most important are among those.

use std::collections::HashSet;

use crate::estimation::gram::Gram;
use crate::parallel;
use crate::search::dictionary_entry::Entry;

/// Size up to which all subsets are enumerated.
const EXACT: usize = 2;

/// Number of subsets of one size that are extended.
const BEAM: usize = 400;

/// Most columns of a subset.
pub(crate) const MOST: usize = 6;

/// Sweeps of the coordinate descent for the bounded shares.
const SWEEPS: usize = 12;

/// A subset of the columns with its optimal shares.
#[derive(Debug, Clone)]
pub(crate) struct Subset {
    /// Indices of the columns, ascending.
    pub columns: Vec<usize>,
    /// Share of each.
    pub shares: Vec<f64>,
    /// Remaining cost.
    pub cost: f64,
}

/// The subsets of each size up to `largest`, by size and then by cost.
pub(crate) fn best_subsets(gram: &Gram, entries: &[Entry], largest: usize) -> Vec<Vec<Subset>> {
    let empty = Subset {
        columns: Vec::new(),
        shares: Vec::new(),
        cost: gram.square,
    };
    let mut sizes = vec![vec![empty]];
    for size in 1..=largest.min(MOST) {
        let beam = if size <= EXACT { usize::MAX } else { BEAM };
        let grown = grown(gram, entries, &sizes[size - 1], beam);
        if grown.is_empty() {
            break;
        }
        sizes.push(grown);
    }
    sizes
}

/// All subsets with one column more than the `beam` best of `smaller`, without duplicates, by cost.
fn grown(gram: &Gram, entries: &[Entry], smaller: &[Subset], beam: usize) -> Vec<Subset> {
    let mut seen = HashSet::new();
    let mut wanted = Vec::new();
    for subset in smaller.iter().take(beam) {
        for column in 0..entries.len() {
            let id = entries[column].id();
            if subset.columns.iter().any(|&own| entries[own].id() == id) {
                continue;
            }
            let mut columns = subset.columns.clone();
            columns.push(column);
            columns.sort_unstable();
            if seen.insert(columns.clone()) {
                wanted.push(columns);
            }
        }
    }
    let mut grown = parallel::map(wanted, |columns| fitted(gram, entries, columns));
    grown.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    grown
}

/// The optimal shares of some columns within their bounds.
pub(crate) fn fitted(gram: &Gram, entries: &[Entry], columns: Vec<usize>) -> Subset {
    let count = columns.len();
    let mut shares = [0.0; MOST];
    // Gradient of half the cost.
    let mut slope = [0.0; MOST];
    for (slope, &column) in slope.iter_mut().zip(&columns) {
        *slope = -gram.pull[column];
    }
    for sweep in 0..SWEEPS {
        let mut moved: f64 = 0.0;
        for k in 0..count {
            let column = columns[k];
            let square = gram.matrix[(column, column)];
            let (low, high) = entries[column].share;
            let wanted = if square > 0.0 {
                (shares[k] - slope[k] / square).clamp(low, high)
            } else {
                low.max(0.0).min(high)
            };
            let step = wanted - shares[k];
            if step != 0.0 {
                shares[k] = wanted;
                for (slope, &other) in slope.iter_mut().zip(&columns) {
                    *slope += step * gram.matrix[(other, column)];
                }
                moved = moved.max(step.abs());
            }
        }
        if moved < 1e-4 && sweep > 0 {
            break;
        }
    }
    // `square - 2 pull x + x matrix x` with `matrix x - pull` the slope.
    let cost = gram.square
        + (0..count)
            .map(|k| shares[k] * (slope[k] - gram.pull[columns[k]]))
            .sum::<f64>();
    Subset {
        shares: shares[..count].to_vec(),
        columns,
        cost,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::search::dictionary_entry::Kind;
    use hitch_plant::AddedEffect;
    use nalgebra::{DMatrix, DVector};

    /// Columns of a small problem, one for each effect of the catalogue's first different ones.
    fn problem() -> (Gram, Vec<Entry>, DMatrix<f64>, DVector<f64>) {
        let columns = DMatrix::from_fn(8, 5, |row, column| {
            ((row * 7 + column * 13 + row * column * 3) % 11) as f64 - 5.0
        });
        let right = DVector::from_fn(8, |row, _| ((row * 5) % 7) as f64 - 3.0);
        let gram = Gram {
            matrix: columns.transpose() * &columns,
            pull: columns.transpose() * &right,
            square: right.dot(&right),
        };
        let mut entries: Vec<Entry> = Vec::new();
        for &effect in hitch_effects::CATALOGUE {
            let known = entries.iter().any(|entry| entry.id() == effect.id());
            if entries.len() < columns.ncols() && !known {
                entries.push(Entry {
                    kind: Kind::New,
                    added: AddedEffect::typical(effect),
                    off: 0.0,
                    change: Vec::new(),
                    share: (f64::NEG_INFINITY, f64::INFINITY),
                });
            }
        }
        (gram, entries, columns, right)
    }

    /// What least squares leaves with some of the columns.
    fn left(columns: &DMatrix<f64>, right: &DVector<f64>, chosen: &[usize]) -> f64 {
        let chosen = columns.select_columns(chosen);
        let normal = chosen.transpose() * &chosen;
        let shares = normal.cholesky().expect("independent columns");
        let shares = shares.solve(&(chosen.transpose() * right));
        (right - chosen * shares).norm_squared()
    }

    #[test]
    fn the_best_subset_of_each_size_is_that_of_an_exhaustive_search() {
        let (gram, entries, columns, right) = problem();
        let best = best_subsets(&gram, &entries, 3);
        for (size, subsets) in best.iter().enumerate().skip(1) {
            let all = (0..1usize << entries.len()).filter(|bits| bits.count_ones() == size as u32);
            let costs = all.map(|bits| {
                let chosen: Vec<usize> =
                    (0..entries.len()).filter(|k| bits >> k & 1 == 1).collect();
                left(&columns, &right, &chosen)
            });
            let least = costs.fold(f64::INFINITY, f64::min);
            let found = subsets[0].cost;
            assert!(
                (found - least).abs() < 1e-3 * gram.square,
                "{size}: {found}, {least}"
            );
        }
    }

    #[test]
    fn shares_stay_within_their_ranges() {
        let (gram, mut entries, ..) = problem();
        for entry in &mut entries {
            entry.share = (0.0, 0.1);
        }
        for subset in best_subsets(&gram, &entries, 2).iter().flatten() {
            assert!(
                subset
                    .shares
                    .iter()
                    .all(|share| (0.0..=0.1).contains(share))
            );
        }
    }
}
