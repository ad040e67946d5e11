//! Gram matrix of the dictionary's columns, with all nuisance parameters projected out.
//!
//! The cost is quadratic in the shares of the columns, so this matrix is sufficient to evaluate every subset without a
//! simulation. Load errors are eliminated run by run, clocks and the shapes of effects by a Schur complement, each with
//! its prior.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::estimate::Estimate;
use crate::estimation::jacobian::{Jacobian, RunJacobian};
use crate::estimation::residual_columns::dot;
use crate::search::dictionary_entry::Entry;

/// The quadratic cost `square - 2 pull x + x matrix x` of shares `x`.
#[derive(Debug, Clone)]
pub(crate) struct Gram {
    /// Dot products of the columns.
    pub matrix: DMatrix<f64>,
    /// Dot products of the columns with the residuals.
    pub pull: DVector<f64>,
    /// Cost at zero shares.
    pub square: f64,
}

/// Remaining share of a nuisance parameter's diagonal entry below which it is singular.
const SINGULAR: f64 = 1e-9;

impl Gram {
    /// The matrix of `entries`, around `residuals` without any of them; `nuisances` are the columns of the Jacobian to
    /// project out.
    pub fn new(
        jacobian: &Jacobian,
        estimate: &Estimate,
        nuisances: &[usize],
        residuals: &[Vec<f64>],
        entries: &[Entry],
    ) -> Self {
        let runs = jacobian.runs.par_iter().enumerate();
        let size = nuisances.len() + entries.len() + 1;
        let whole = runs
            .map(|(index, run)| {
                let columns = nuisances
                    .iter()
                    .map(|&column| run.shared[column].as_slice());
                let entries = entries.iter().map(|entry| entry.change[index].as_slice());
                let columns: Vec<&[f64]> = columns
                    .chain(entries)
                    .chain([residuals[index].as_slice()])
                    .collect();
                of_run(run, &columns)
            })
            .reduce(|| DMatrix::zeros(size, size), |one, other| one + other);
        let mut whole = whole;
        let last = size - 1;
        for (row, &column) in nuisances.iter().enumerate() {
            let shared = jacobian.shared[column];
            if shared.has_prior() {
                let value = estimate.get(shared) / estimate.scale(shared);
                whole[(row, row)] += 1.0;
                whole[(row, last)] -= value;
                whole[(last, row)] -= value;
                whole[(last, last)] += value * value;
            }
        }
        eliminate(&mut whole, nuisances.len());
        let (first, count) = (nuisances.len(), entries.len());
        Self {
            matrix: whole.view((first, first), (count, count)).into_owned(),
            pull: whole.view((first, last), (count, 1)).column(0).into_owned(),
            square: whole[(last, last)],
        }
    }
}

/// Dot products of the columns of one run, its load error eliminated.
fn of_run(run: &RunJacobian, columns: &[&[f64]]) -> DMatrix<f64> {
    let size = columns.len();
    let mut matrix = DMatrix::zeros(size, size);
    for row in 0..size {
        for column in 0..=row {
            let product = dot(columns[row], columns[column]);
            matrix[(row, column)] = product;
            matrix[(column, row)] = product;
        }
    }
    if let Some(load) = &run.load {
        let mut coupling = DVector::from_iterator(size, columns.iter().map(|c| dot(c, load)));
        coupling[size - 1] -= run.load_value;
        matrix[(size - 1, size - 1)] += run.load_value * run.load_value;
        let square = dot(load, load) + 1.0;
        matrix -= &coupling * coupling.transpose() / square;
    }
    matrix
}

/// Eliminates the first `count` unknowns from a Gram matrix, one after the other.
fn eliminate(matrix: &mut DMatrix<f64>, count: usize) {
    let own: Vec<f64> = (0..count).map(|k| matrix[(k, k)]).collect();
    for k in 0..count {
        let pivot = matrix[(k, k)];
        if pivot <= SINGULAR * own[k].max(1e-12) {
            continue;
        }
        let row = matrix.column(k).into_owned();
        for column in k + 1..matrix.ncols() {
            let share = row[column] / pivot;
            if share != 0.0 {
                for r in k + 1..matrix.nrows() {
                    matrix[(r, column)] -= share * row[r];
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::eliminate;
    use nalgebra::DMatrix;

    /// Eliminating an unknown equals projecting its column out of the others.
    #[test]
    fn eliminating_an_unknown_projects_its_column_out() {
        let columns = DMatrix::from_row_slice(
            4,
            3,
            &[1.0, 2.0, 0.5, 0.0, 1.0, -1.0, 3.0, 0.2, 2.0, -1.0, 1.0, 1.5],
        );
        let mut gram = columns.transpose() * &columns;
        eliminate(&mut gram, 1);
        let first = columns.column(0);
        let project = |k: usize| {
            let column = columns.column(k);
            column - first * (first.dot(&column) / first.dot(&first))
        };
        for (a, b) in [(1, 1), (1, 2), (2, 2)] {
            assert!((gram[(a, b)] - project(a).dot(&project(b))).abs() < 1e-12);
        }
    }
}
