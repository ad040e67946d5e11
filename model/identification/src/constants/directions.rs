//! Independent directions of the errors of all constants.

use hitch_plant::{Constants, Model};
use nalgebra::{DMatrix, DVector};

use crate::constants::correction::corrected;
use crate::constants::fitted::{CurvePoint, DETERMINED, Fitted, FittedConstant, MODEL_ERROR};
use crate::constants::parameter::Parameter;
use crate::constants::prior::Prior;
use crate::constants::tolerances::Tolerances;

/// Smallest kept variance of a direction, in variances of a single constant. The errors of neighbouring points of a
/// flow curve are correlated: a curve of any number of points has about five directions above this variance.
const SMALLEST_VARIANCE: f64 = 0.02;

/// Principal directions of the prior of a model's constants.
#[derive(Debug)]
pub struct Directions {
    parameters: Vec<Parameter>,
    prior: Prior,
    /// One column per direction: the errors of the parameters at one sigma.
    columns: DMatrix<f64>,
}

impl Directions {
    /// The directions of a model's constants, with a user's own tolerances.
    #[must_use]
    pub fn new(declared: &Constants, own: &Tolerances) -> Self {
        let parameters = own.unknowns(declared);
        let prior = Prior::new(declared, &parameters, own);
        let sigma = DVector::from_column_slice(&prior.sigma);
        let size = parameters.len();
        let correlation = DMatrix::from_fn(size, size, |i, j| {
            prior.covariance[(i, j)] / (sigma[i] * sigma[j])
        });
        let principal = correlation.symmetric_eigen();
        let mut order: Vec<usize> = (0..size)
            .filter(|&k| principal.eigenvalues[k] >= SMALLEST_VARIANCE)
            .collect();
        order.sort_by(|&a, &b| principal.eigenvalues[b].total_cmp(&principal.eigenvalues[a]));
        let column = |&k: &usize| {
            let scaled = principal.eigenvectors.column(k) * principal.eigenvalues[k].sqrt();
            scaled.component_mul(&sigma)
        };
        let columns: Vec<DVector<f64>> = order.iter().map(column).collect();
        Self {
            columns: if columns.is_empty() {
                DMatrix::zeros(size, 0)
            } else {
                DMatrix::from_columns(&columns)
            },
            parameters,
            prior,
        }
    }

    /// Number of directions.
    #[must_use]
    pub fn len(&self) -> usize {
        self.columns.ncols()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Errors of the parameters at these numbers of sigmas along the directions.
    fn errors(&self, sigmas: &[f64]) -> DVector<f64> {
        &self.columns * DVector::from_column_slice(sigmas)
    }

    /// Constants and points of the flow curves of the second model, the first one corrected, with intervals from the
    /// covariance of the directions, in tolerances; one sigma of the prior is this share of a tolerance.
    pub(crate) fn fitted(
        &self,
        [declared, model]: [&Model; 2],
        errors: &[f64],
        share: f64,
        covariance: &DMatrix<f64>,
    ) -> (Vec<FittedConstant>, Vec<CurvePoint>) {
        let prior = &self.prior;
        let spread = &self.columns * covariance * self.columns.transpose();
        let own: Vec<f64> = (0..prior.sigma.len())
            .map(|k| spread[(k, k)].sqrt().hypot(MODEL_ERROR))
            .collect();
        let pairs = own.iter().zip(&prior.sigma);
        let determined: Vec<bool> = pairs
            .clone()
            .map(|(own, prior)| *own <= DETERMINED * (share * prior).hypot(MODEL_ERROR))
            .collect();
        let sigma: Vec<f64> = pairs
            .zip(&determined)
            .map(|((own, prior), is_determined)| match is_determined {
                true => own.min(*prior),
                false => *prior,
            })
            .collect();
        let fitted = Fitted {
            declared,
            model,
            parameters: &self.parameters,
            theta: &self.errors(errors),
            sigma: &sigma,
            determined: &determined,
            prior,
        };
        (fitted.constants(), fitted.curves())
    }

    /// The declared model with its constants moved along the directions by these numbers of sigmas; `None` if the
    /// dimensions make no linkage.
    #[must_use]
    pub fn corrected(&self, declared: &Model, sigmas: &[f64]) -> Option<Model> {
        let errors = self.errors(sigmas);
        corrected(declared, &self.parameters, &errors)
    }
}

#[cfg(test)]
mod tests {
    use super::Directions;
    use crate::constants::tolerances::Tolerances;

    /// The directions reproduce the prior covariance up to the small variances that are left out.
    #[test]
    fn directions_reproduce_the_prior() {
        for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
            let directions = Directions::new(model.constants(), &Tolerances::default());
            let prior = &directions.prior;
            let product = &directions.columns * directions.columns.transpose();
            println!("{} directions of {}", directions.len(), prior.sigma.len());
            assert!(directions.len() < prior.sigma.len());
            for (i, sigma_i) in prior.sigma.iter().enumerate() {
                for (j, sigma_j) in prior.sigma.iter().enumerate() {
                    let missing = prior.covariance[(i, j)] - product[(i, j)];
                    assert!(
                        missing.abs() < 0.05 * sigma_i * sigma_j,
                        "{i} {j}: {missing}"
                    );
                }
            }
        }
    }

    #[test]
    fn no_error_leaves_the_constants_alone() {
        let model = hitch_model_file::nominal();
        let directions = Directions::new(model.constants(), &Tolerances::default());
        let same = directions.corrected(&model, &vec![0.0; directions.len()]);
        assert_eq!(same.expect("a linkage").constants(), model.constants());
    }
}
