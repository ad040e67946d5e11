//! What free constants are worth at a fit with the declared ones, to first order.
//!
//! Constants of a data sheet are off by most of their tolerances, those of a fitted model by some hundredths. The width of
//! their prior is therefore one of a few shares of the tolerances, and that of the largest marginal likelihood is used
//! (MacKay 1992). All of them follow from one Jacobian.
//!
//! No constant is exact: the smallest share is the accuracy that no model exceeds. Every hypothesis has it, so that it costs
//! nothing, and an effect has to explain more than such errors can.

use nalgebra::{DMatrix, DVector};

use crate::constants::free::FreeConstants;
use crate::constants::tolerances::FARTHEST_SIGMAS;
use crate::data::problem::Problem;
use crate::estimation::bounded_minimum::minimum_within;
use crate::estimation::fit::Fit;
use crate::selection::complexity_penalty::Penalty;
use crate::selection::constants_sensitivities::Sensitivities;

/// Possible widths of the prior, in tolerances, the smallest one last: two thousandths of a flow curve.
const SHARES: [f64; 4] = [1.0, 0.25, 0.06, LEAST_SHARE];

/// Width of the prior that every hypothesis has, in tolerances.
const LEAST_SHARE: f64 = 0.015;

/// Possible widths of the prior in a fit. Residuals beyond noise reduce the information of the campaign: a likelihood ratio
/// of one is a cost of [`Penalty::unit`]. In a fit, whose cost counts every residual in full, the prior is narrower by as much.
pub(crate) fn shares(penalty: Penalty) -> [f64; 4] {
    SHARES.map(|share| share / penalty.unit.sqrt())
}

/// The smallest of these widths.
pub(crate) fn least_share(penalty: Penalty) -> f64 {
    LEAST_SHARE / penalty.unit.sqrt()
}

/// The cost of a fit over the errors of its constants, in tolerances; all other parameters are optimal.
#[derive(Debug, Clone)]
pub(crate) struct ConstantsCost {
    /// Half of the second derivative, without the prior.
    curvature: DMatrix<f64>,
    /// Half of the negative gradient where all errors are zero.
    pull: DVector<f64>,
    /// Cost at the fit, with its own prior, less that where all errors are zero.
    at_fit: f64,
}

impl ConstantsCost {
    /// At a fit, whose constants are freed if they are not.
    pub fn at(problem: Problem<'_>, fit: &Fit) -> Self {
        let mut free = fit.clone();
        let constants = &mut free.estimate.constants;
        constants.get_or_insert_with(|| FreeConstants::of(problem.model));
        Self::of(&Sensitivities::at(problem, &free))
    }

    /// From sensitivities at a fit with free constants.
    pub fn of(sensitivities: &Sensitivities) -> Self {
        let constants = sensitivities.estimate.constants.as_ref();
        let share = constants.map_or(1.0, FreeConstants::share);
        let errors = constants.map_or(&[][..], FreeConstants::errors);
        let errors = DVector::from_column_slice(errors);
        let (precision, right) = sensitivities.normal_equations();
        let prior = DMatrix::identity(precision.nrows(), precision.ncols());
        let curvature = (precision - prior) / share.powi(2);
        let pull_at_fit = (right + &errors / share) / share;
        let bent = &curvature * &errors;
        let pull = pull_at_fit + &bent;
        let at_fit = errors.norm_squared() / share.powi(2) + errors.dot(&(bent - 2.0 * &pull));
        Self {
            curvature,
            pull,
            at_fit,
        }
    }

    /// Reduction of the penalised cost by constants with a prior of this width. What wider priors cost is relative to the
    /// smallest one; as an effect, they have to exceed the smallest accepted detectability.
    pub fn gain(&self, share: f64, penalty: Penalty) -> f64 {
        self.at_fit + self.reduction(share) - self.price(share, penalty)
    }

    /// Cost reduction that constants with a prior of this width need: see [`Penalty::of_constants`]; the factor
    /// is that relative to the smallest prior.
    pub fn price(&self, share: f64, penalty: Penalty) -> f64 {
        let least = least_share(penalty);
        // The next wider prior is four times as wide.
        if share < 2.0 * least {
            return 0.0;
        }
        let narrowed = self.narrowed(share) - self.narrowed(least);
        penalty.of_constants(narrowed)
    }

    /// Reduction of the cost by constants with a prior of this width and within its bounds, compared with errors of zero.
    pub fn reduction(&self, share: f64) -> f64 {
        let (precision, pull) = (self.precision(share), &self.pull * share);
        let ranges = vec![(-FARTHEST_SIGMAS, FARTHEST_SIGMAS); pull.len()];
        let errors = minimum_within(&precision, &pull, &ranges);
        errors.map_or(0.0, |errors| {
            errors.dot(&(2.0 * pull - precision * &errors))
        })
    }

    /// Logarithm of the determinant of the posterior's precision, in units of that of a prior of this width.
    pub fn narrowed(&self, share: f64) -> f64 {
        log_determinant(&self.precision(share))
    }

    fn precision(&self, share: f64) -> DMatrix<f64> {
        let prior = DMatrix::identity(self.pull.len(), self.pull.len());
        &self.curvature * share.powi(2) + prior
    }
}

/// Logarithm of the determinant of a positive definite matrix.
fn log_determinant(matrix: &DMatrix<f64>) -> f64 {
    let values = matrix.clone().symmetric_eigenvalues();
    values.iter().map(|value| value.max(1.0).ln()).sum()
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::{ConstantsCost, SHARES, log_determinant};

    #[test]
    fn the_logarithm_of_a_determinant_is_a_sum() {
        let logarithm = log_determinant(&DMatrix::from_diagonal_element(3, 3, 2.0));
        assert!((logarithm - 3.0 * 2f64.ln()).abs() < 1e-12);
    }

    /// For a single constant the reduction and the factor by which the prior is narrowed have closed forms.
    #[test]
    fn a_single_constant_has_a_closed_form() {
        let (curvature, pull) = (900.0, 60.0);
        let cost = ConstantsCost {
            curvature: DMatrix::from_element(1, 1, curvature),
            pull: DVector::from_element(1, pull),
            at_fit: 0.0,
        };
        for share in SHARES {
            let precision = curvature + 1.0 / (share * share);
            let reduction = pull * pull / precision;
            assert!((cost.reduction(share) / reduction - 1.0).abs() < 1e-12);
            let narrowed = (precision * share * share).ln();
            assert!((cost.narrowed(share) - narrowed).abs() < 1e-12);
        }
    }

    /// An error beyond the bound of its prior reduces the cost by as much as at the bound.
    #[test]
    fn a_constant_stays_within_its_bound() {
        let (curvature, pull, share) = (900.0, 600.0, 0.06);
        let cost = ConstantsCost {
            curvature: DMatrix::from_element(1, 1, curvature),
            pull: DVector::from_element(1, pull),
            at_fit: 0.0,
        };
        let bound = 3.0 * share;
        let reduction = bound * (2.0 * pull - (curvature + 1.0 / (share * share)) * bound);
        assert!((cost.reduction(share) / reduction - 1.0).abs() < 1e-12);
    }
}
