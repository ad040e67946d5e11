//! Estimates and evidence of Gaussian linear models, in closed form, for each shape of the soil's variation.

use nalgebra::{DMatrix, DVector};

use crate::term::Prior;
use crate::whitening::{Row, Shape, shapes, whitened};

/// Sums of products of the columns and the measured draft, which is the last column.
#[derive(Debug, Clone)]
struct Products {
    gram: DMatrix<f64>,
    samples: usize,
    /// Logarithm of the determinant of the covariance, with a `σ` of 1 in the soil.
    log_determinant: f64,
}

/// The data in the form in which every model of them is weighed.
#[derive(Debug, Clone)]
pub struct Evidence {
    in_soil: Vec<(Shape, Products)>,
    above: Products,
    priors: Vec<Prior>,
}

/// A model's estimates for one shape.
#[derive(Debug, Clone)]
pub struct Estimate {
    /// Shape of the variation.
    pub shape: Shape,
    /// Its standard deviation over the draft, 1.
    pub variation: f64,
    /// Logarithm of the evidence.
    pub log_evidence: f64,
    /// Means of the model's terms.
    pub means: DVector<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
}

/// Steps of the search for the variation, in its logarithm; each more than halves the distance from the maximum.
const STEPS: usize = 8;

impl Evidence {
    /// Of rows in the soil relative to the expected draft, whose logarithms sum up to `log_scale`, and rows above it relative to
    /// the deviation of their noise. The last value of a row is the measured draft, the others are those of the terms with
    /// these priors.
    #[must_use]
    pub fn new(rows: &[Row], log_scale: f64, above: &[Vec<f64>], priors: Vec<Prior>) -> Self {
        let size = priors.len() + 1;
        let in_soil = shapes().map(|shape| {
            let white = whitened(rows, shape);
            let log_determinant = white.log_determinant + 2.0 * log_scale;
            (shape, Products::of(&white.rows, size, log_determinant))
        });
        Self {
            in_soil: in_soil.collect(),
            above: Products::of(above, size, 0.0),
            priors,
        }
    }

    /// The estimates of the model with these terms, by index, for each shape. Shapes without a solution are left out.
    #[must_use]
    pub fn estimates(&self, terms: &[usize]) -> Vec<Estimate> {
        let model = Model::new(self, terms);
        let of_shape =
            |(shape, products): &(Shape, Products)| model.at_its_variation(*shape, products, terms);
        self.in_soil.iter().filter_map(of_shape).collect()
    }

    /// Number of independent samples that determine a single factor of the draft as well, for this shape; the column of the
    /// expected draft itself has this index.
    #[must_use]
    pub fn effective_samples(&self, shape: Shape, column: usize) -> f64 {
        let mut known = self.in_soil.iter();
        known
            .find(|(other, _)| *other == shape)
            .map_or(0.0, |(_, products)| products.gram[(column, column)])
    }
}

impl Products {
    fn of(rows: &[Vec<f64>], size: usize, log_determinant: f64) -> Self {
        let mut gram = DMatrix::zeros(size, size);
        for row in rows {
            for (i, left) in row.iter().enumerate() {
                for (j, right) in row.iter().enumerate().skip(i) {
                    gram[(i, j)] += left * right;
                }
            }
        }
        gram.fill_lower_triangle_with_upper_triangle();
        Self {
            gram,
            samples: rows.len(),
            log_determinant,
        }
    }

    /// Products of chosen terms, those with the draft, and the square of the draft.
    fn chosen(&self, terms: &[usize]) -> (DMatrix<f64>, DVector<f64>, f64) {
        let last = self.gram.nrows() - 1;
        let count = terms.len();
        let gram = DMatrix::from_fn(count, count, |i, j| self.gram[(terms[i], terms[j])]);
        let with_draft = DVector::from_fn(count, |i, _| self.gram[(terms[i], last)]);
        (gram, with_draft, self.gram[(last, last)])
    }
}

/// What does not depend on the shape: priors, and the rows above the soil.
struct Model {
    precision: DMatrix<f64>,
    weighted: DVector<f64>,
    square: f64,
    log_prior: f64,
}

impl Model {
    fn new(evidence: &Evidence, terms: &[usize]) -> Self {
        let (mut precision, mut weighted, mut square) = evidence.above.chosen(terms);
        let mut log_prior = 0.0;
        for (place, term) in terms.iter().enumerate() {
            let Prior { mean, deviation } = evidence.priors[*term];
            let known = deviation.powi(-2);
            precision[(place, place)] += known;
            weighted[place] += mean * known;
            square += mean * mean * known;
            log_prior -= deviation.ln();
        }
        Self {
            precision,
            weighted,
            square,
            log_prior,
        }
    }

    /// The estimate at the variation of the largest evidence: a fixed point of `σ² = (r'r + σ² tr) / n`, which is
    /// expectation and maximisation.
    fn at_its_variation(
        &self,
        shape: Shape,
        products: &Products,
        terms: &[usize],
    ) -> Option<Estimate> {
        let chosen = products.chosen(terms);
        let samples = products.samples as f64;
        let mut variance = 0.01;
        for _ in 0..STEPS {
            let (means, covariance, _) = self.solved(&chosen, variance)?;
            let (gram, with_draft, square) = &chosen;
            let rest = square - 2.0 * means.dot(with_draft) + (gram * &means).dot(&means);
            let uncertain = (gram * &covariance).trace();
            variance = ((rest + uncertain) / samples).max(1e-6);
        }
        let (means, covariance, log_evidence) = self.solved(&chosen, variance)?;
        let log_evidence =
            log_evidence - 0.5 * samples * variance.ln() - 0.5 * products.log_determinant;
        log_evidence.is_finite().then_some(Estimate {
            shape,
            variation: variance.sqrt(),
            log_evidence,
            means,
            covariance,
        })
    }

    /// Means, covariance and the evidence but for the determinant of the noise.
    fn solved(
        &self,
        (gram, with_draft, square): &(DMatrix<f64>, DVector<f64>, f64),
        variance: f64,
    ) -> Option<(DVector<f64>, DMatrix<f64>, f64)> {
        let precision = gram / variance + &self.precision;
        let weighted = with_draft / variance + &self.weighted;
        // Terms have different units: the diagonal scales them.
        let scales = precision.diagonal().map(|value| value.sqrt().recip());
        let scaled = DMatrix::from_fn(precision.nrows(), precision.ncols(), |i, j| {
            precision[(i, j)] * scales[i] * scales[j]
        });
        let factor = scaled.cholesky()?;
        let log_determinant =
            2.0 * factor.l_dirty().diagonal().map(f64::ln).sum() - 2.0 * scales.map(f64::ln).sum();
        let inverse = factor.inverse();
        let covariance = DMatrix::from_fn(inverse.nrows(), inverse.ncols(), |i, j| {
            inverse[(i, j)] * scales[i] * scales[j]
        });
        let means = &covariance * &weighted;
        let quadratic = square / variance + self.square - means.dot(&weighted);
        let log_evidence = self.log_prior - 0.5 * (log_determinant + quadratic);
        Some((means, covariance, log_evidence))
    }
}
