//! The variation of the soil along a run, and its removal from the columns of a linear model.
//!
//! The relative variation between blocks is `σ (u(x) + e)`: a first-order process `u` of correlation length `L` and the variance
//! `1 - λ`, and a white part of the variance `λ`. Innovations of the scalar Kalman filter of this process, divided by their
//! deviations, are white: the filter is linear, so that it is applied to every column alike.

/// Shape of the variation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shape {
    /// Correlation length `L`, m.
    pub length_m: f64,
    /// White share `λ` of the variance, above 0.
    pub white_share: f64,
}

/// Correlation lengths that are weighed against each other, m: from a block to more than a run.
const LENGTHS_M: [f64; 8] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0];
/// White shares that are weighed against each other.
const WHITE_SHARES: [f64; 7] = [0.01, 0.03, 0.1, 0.2, 0.4, 0.65, 0.9];

/// All shapes that are weighed against each other, with equal prior probability.
pub fn shapes() -> impl Iterator<Item = Shape> {
    LENGTHS_M.into_iter().flat_map(|length_m| {
        WHITE_SHARES.into_iter().map(move |white_share| Shape {
            length_m,
            white_share,
        })
    })
}

/// A row of relative values of all columns at a place of a run.
#[derive(Debug, Clone)]
pub struct Row {
    /// Index of the run.
    pub run: usize,
    /// Travel, m.
    pub at_m: f64,
    /// Value of each column over the expected draft.
    pub values: Vec<f64>,
}

/// Whitened rows, for a `σ` of 1.
#[derive(Debug, Clone)]
pub struct Whitened {
    /// The rows in the order of the blocks.
    pub rows: Vec<Vec<f64>>,
    /// Logarithm of the determinant of the covariance.
    pub log_determinant: f64,
}

/// Whitens rows, which are ordered by run and travel.
#[must_use]
pub fn whitened(rows: &[Row], shape: Shape) -> Whitened {
    let long = 1.0 - shape.white_share;
    let mut white = Vec::with_capacity(rows.len());
    let mut log_determinant = 0.0;
    let mut before: Option<&Row> = None;
    let columns = rows.first().map_or(0, |row| row.values.len());
    let (mut state, mut variance) = (vec![0.0; columns], long);
    for row in rows {
        match before.filter(|before| before.run == row.run) {
            None => {
                state.fill(0.0);
                variance = long;
            }
            Some(before) => {
                let kept = (-(row.at_m - before.at_m).max(0.0) / shape.length_m).exp();
                state.iter_mut().for_each(|value| *value *= kept);
                variance = long + kept * kept * (variance - long);
            }
        }
        before = Some(row);
        let expected = variance + shape.white_share;
        let (gain, deviation) = (variance / expected, expected.sqrt());
        log_determinant += expected.ln();
        let mut innovations = Vec::with_capacity(columns);
        for (state, value) in state.iter_mut().zip(&row.values) {
            let innovation = value - *state;
            *state += gain * innovation;
            innovations.push(innovation / deviation);
        }
        variance *= 1.0 - gain;
        white.push(innovations);
    }
    Whitened {
        rows: white,
        log_determinant,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    /// The quadratic form and the determinant agree with those of the covariance matrix itself, at uneven distances and over two
    /// runs.
    #[test]
    fn whitening_is_that_of_the_covariance() {
        let places = [
            (0, 0.4),
            (0, 1.5),
            (0, 2.2),
            (0, 9.0),
            (1, 0.1),
            (1, 3.0),
            (1, 3.7),
        ];
        let shape = Shape {
            length_m: 3.0,
            white_share: 0.3,
        };
        let values = [1.0, -0.5, 0.3, 2.0, 0.7, -1.1, 0.2];
        let rows: Vec<Row> = places
            .iter()
            .zip(values)
            .map(|(&(run, at_m), value)| Row {
                run,
                at_m,
                values: vec![value],
            })
            .collect();
        let covariance = DMatrix::from_fn(7, 7, |i, j| {
            let ((run, at_m), (other, other_m)) = (places[i], places[j]);
            let near = if run == other {
                0.7 * (-f64::abs(at_m - other_m) / 3.0).exp()
            } else {
                0.0
            };
            near + if i == j { 0.3 } else { 0.0 }
        });
        let y = DVector::from_column_slice(&values);
        let expected = (y.transpose() * covariance.clone().try_inverse().unwrap() * &y)[0];
        let white = whitened(&rows, shape);
        let form: f64 = white.rows.iter().map(|row| row[0] * row[0]).sum();
        assert!((form - expected).abs() < 1e-9, "{form} {expected}");
        assert!((white.log_determinant - covariance.determinant().ln()).abs() < 1e-9);
    }
}
