//! Independent directions of the errors of all constants.

use hitch_plant::Constants;
use nalgebra::{DMatrix, DVector};

use crate::constants::fitted::{DETERMINED, MODEL_ERROR, Posterior};
use crate::constants::parameter::Parameter;
use crate::constants::prior::Prior;
use crate::constants::tolerances::Tolerances;
use crate::parallel;

/// Variance of the smooth directions. The errors of neighbouring points of a flow curve are correlated: a curve of any number
/// of points has about five directions above this variance.
pub const SMOOTH: f64 = 0.02;

/// Part of a unit vector that is rounding.
const NEGLIGIBLE: f64 = 1e-9;

/// Principal directions of the prior of a model's constants.
#[derive(Debug)]
pub struct Directions {
    parameters: Vec<Parameter>,
    prior: Prior,
    /// One column per direction: the errors of the parameters at one sigma.
    columns: DMatrix<f64>,
}

impl Directions {
    /// The directions of some unknowns of a model with at least this variance, in variances of a single constant; with a
    /// user's own tolerances.
    #[must_use]
    pub fn new(
        declared: &Constants,
        parameters: Vec<Parameter>,
        own: &Tolerances,
        smallest_variance: f64,
    ) -> Self {
        let prior = Prior::new(declared, &parameters, own);
        let sigma = DVector::from_column_slice(&prior.sigma);
        let size = parameters.len();
        let correlation = DMatrix::from_fn(size, size, |i, j| {
            prior.covariance[(i, j)] / (sigma[i] * sigma[j])
        });
        // An empty matrix has no decomposition.
        let principal = (size > 0).then(|| correlation.symmetric_eigen());
        let axes = principal.iter().flat_map(|principal| {
            let values = principal.eigenvalues.iter().copied();
            values.zip(principal.eigenvectors.column_iter())
        });
        let mut axes: Vec<_> = axes.filter(|axis| axis.0 >= smallest_variance).collect();
        axes.sort_by(|a, b| b.0.total_cmp(&a.0));
        let columns: Vec<DVector<f64>> = axes
            .into_iter()
            .map(|(variance, axis)| (axis * variance.sqrt()).component_mul(&sigma))
            .collect();
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

    /// The unknowns.
    #[must_use]
    pub fn parameters(&self) -> &[Parameter] {
        &self.parameters
    }

    /// Their prior.
    #[must_use]
    pub fn prior(&self) -> &Prior {
        &self.prior
    }

    /// Errors of the parameters at these numbers of sigmas along the directions.
    pub(crate) fn errors(&self, sigmas: &[f64]) -> DVector<f64> {
        &self.columns * DVector::from_column_slice(sigmas)
    }

    /// Posterior of each unknown, from the covariance of the directions, in tolerances; one sigma of the prior is this share
    /// of a tolerance.
    pub(crate) fn posterior(&self, share: f64, covariance: &DMatrix<f64>) -> Vec<Posterior> {
        let prior = &self.prior;
        let spread = &self.columns * covariance * self.columns.transpose();
        let own: Vec<f64> = (0..prior.sigma.len())
            .map(|k| spread[(k, k)].sqrt().hypot(MODEL_ERROR))
            .collect();
        let pairs = own.iter().zip(&prior.sigma);
        pairs
            .map(|(&own, &prior)| {
                let determined = own <= DETERMINED * (share * prior).hypot(MODEL_ERROR);
                let sigma = if determined { own.min(prior) } else { prior };
                Posterior { sigma, determined }
            })
            .collect()
    }

    /// Columns per prior sigma of each direction, from those per tolerance of each unknown; `None` if it cannot move. One sigma
    /// of the prior is this share of a tolerance.
    pub(crate) fn combined(
        &self,
        of_unknowns: &[Option<Vec<Vec<f64>>>],
        share: f64,
    ) -> Vec<Vec<Vec<f64>>> {
        let known = of_unknowns.iter().flatten().next();
        let zero: Vec<Vec<f64>> = known.map_or(Vec::new(), |column| {
            column.iter().map(|run| vec![0.0; run.len()]).collect()
        });
        let along = |direction: usize| {
            let mut sum = zero.clone();
            for (unknown, column) in of_unknowns.iter().enumerate() {
                let weight = share * self.columns[(unknown, direction)] / self.prior.sigma[unknown];
                if let Some(column) = column
                    && weight.abs() > NEGLIGIBLE
                {
                    let sums = sum.iter_mut().flatten();
                    for (sum, part) in sums.zip(column.iter().flatten()) {
                        *sum += weight * part;
                    }
                }
            }
            sum
        };
        parallel::map(0..self.len(), along)
    }
}

#[cfg(test)]
mod tests {
    use hitch_plant::Model;

    use super::{Directions, SMOOTH};
    use crate::constants::correction::corrected;
    use crate::constants::tolerances::Tolerances;

    fn of(model: &Model) -> Directions {
        let own = Tolerances::default();
        Directions::new(
            model.constants(),
            own.unknowns(model.constants()),
            &own,
            SMOOTH,
        )
    }

    /// The directions reproduce the prior covariance up to the small variances that are left out.
    #[test]
    fn directions_reproduce_the_prior() {
        for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
            let directions = of(&model);
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
        let directions = of(&model);
        let errors = directions.errors(&vec![0.0; directions.len()]);
        let same = corrected(&model, directions.parameters(), &errors);
        assert_eq!(same.expect("a linkage").constants(), model.constants());
    }
}
