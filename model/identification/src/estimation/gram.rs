//! Gram matrices: what a cost that is quadratic in its unknowns needs of their columns.
//!
//! Steps of a descent, the dictionary's best subsets and the covariance of constants are the same matrix with other unknowns
//! eliminated (Schur complement), so that no subset needs a simulation.

use nalgebra::{DMatrix, DVector};

/// The quadratic cost `square - 2 pull x + x matrix x` of unknowns `x`.
#[derive(Debug, Clone)]
pub struct Gram {
    /// Dot products of the columns.
    pub matrix: DMatrix<f64>,
    /// Dot products of the columns with the residuals.
    pub pull: DVector<f64>,
    /// Cost where all unknowns are zero.
    pub square: f64,
}

/// Remaining share of the diagonal entry of an eliminated unknown below which it is singular.
const SINGULAR: f64 = 1e-9;

impl Gram {
    /// From the dot products of columns, the residuals last, with the first `count` unknowns eliminated.
    #[must_use]
    pub fn eliminating(mut whole: DMatrix<f64>, count: usize) -> Self {
        eliminate(&mut whole, count);
        let last = whole.nrows() - 1;
        let left = last - count;
        Self {
            matrix: whole.view((count, count), (left, left)).into_owned(),
            pull: whole.view((count, last), (left, 1)).column(0).into_owned(),
            square: whole[(last, last)],
        }
    }
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
