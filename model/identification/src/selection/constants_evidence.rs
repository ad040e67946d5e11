//! Evidence that the constants of the declared model are off.
//!
//! Two hypotheses are compared: the declared constants are exact, or they differ from the machine within the tolerances
//! of data sheets. Their marginal likelihoods (Laplace's approximation) differ by the reduction of the cost that free
//! constants bring, less the logarithm of the factor by which the campaign narrows their prior: constants that the
//! campaign determines have to explain much to be worth it.

use nalgebra::DMatrix;

use crate::constants::free::FreeConstants;
use crate::data::problem::Problem;
use crate::estimate::{Estimate, Shared};
use crate::estimation::fit::Fit;
use crate::estimation::jacobian::{Jacobian, difference, huber, huber_residuals};
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::slow_columns::SlowColumns;
use crate::selection::candidate::{explained_share, plausibility};
use crate::selection::complexity_penalty::Penalty;

/// The constants of a fit, free to first order.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FreedConstants {
    /// Reduction of the cost by fitting them; zero at a fit with free constants.
    reduction: f64,
    /// Cost reduction that they need, in units of the likelihood ratio: logarithm of the determinant of the posterior's
    /// precision, in units of the prior's.
    needed_ratio: f64,
    /// Share of the mean square beyond noise that their present values explain: see [`explained_share`].
    explained_share: f64,
}

/// Sensitivities at a fit with free constants.
struct Sensitivities {
    estimate: Estimate,
    residuals: Vec<Vec<f64>>,
    jacobian: Jacobian,
}

impl Sensitivities {
    /// At a fit, whose constants are freed if they are not.
    fn at(problem: Problem<'_>, fit: &Fit) -> Self {
        let estimate = match &fit.estimate.constants {
            Some(_) => fit.estimate.clone(),
            None => fit.estimate.clone().with_free_constants(problem.model),
        };
        let residuals = huber(fit.residuals.clone());
        let weights = &fit.weights;
        let slow = SlowColumns::new(problem, weights, &estimate, &residuals);
        let jacobian = Jacobian::with_slow_columns(problem, weights, &estimate, &residuals, &slow);
        Self {
            estimate,
            residuals,
            jacobian,
        }
    }

    fn is_constant(&self, column: usize) -> bool {
        matches!(self.jacobian.shared[column], Shared::Constants(_))
    }

    /// Precision of the constants with all other parameters eliminated, in units of the prior's.
    fn precision(&self) -> DMatrix<f64> {
        let (matrix, _) = self.jacobian.reduced(&self.estimate);
        let columns = 0..self.jacobian.shared.len();
        let (own, others): (Vec<usize>, Vec<usize>) =
            columns.partition(|&column| self.is_constant(column));
        schur_complement(&matrix, &own, &others)
    }
}

/// Covariance of the constants of a fit, in units of the prior's; residuals beyond noise widen it. `None` if they are
/// not free, or the covariance is singular.
pub(crate) fn covariance(problem: Problem<'_>, fit: &Fit) -> Option<DMatrix<f64>> {
    fit.estimate.constants.as_ref()?;
    let unit = Penalty::given(problem.experiment, fit).unit;
    let precision = Sensitivities::at(problem, fit).precision();
    // Residuals beyond noise reduce the information of the campaign, not that of the prior.
    let prior = DMatrix::identity(precision.nrows(), precision.ncols());
    let tempered = (precision - &prior) / unit + prior;
    Some(tempered.cholesky()?.inverse())
}

impl FreedConstants {
    /// At a fit, whose constants are freed if they are not.
    pub fn at(problem: Problem<'_>, fit: &Fit) -> Self {
        let sensitivities = Sensitivities::at(problem, fit);
        let Sensitivities {
            estimate,
            residuals,
            jacobian,
        } = &sensitivities;
        let is_constant = |column: usize| sensitivities.is_constant(column);
        let others = NuisanceProjection::keeping(jacobian, estimate, |k| !is_constant(k));
        let all = NuisanceProjection::keeping(jacobian, estimate, |_| true);
        let declared = Estimate {
            constants: None,
            ..estimate.clone()
        };
        let without = huber_residuals(problem, &fit.weights, &declared);
        let (changes, _) = others.project_within_range(difference(&without, residuals));
        Self {
            reduction: others.here() - all.here(),
            needed_ratio: log_determinant(&sensitivities.precision()),
            explained_share: explained_share(&changes, residuals),
        }
    }

    /// Whether free constants at a fit are predicted to cost less than the best fit with the declared ones, with the
    /// effects of both.
    pub fn are_worthwhile(&self, problem: Problem<'_>, fit: &Fit, best: &Fit) -> bool {
        let penalty = Penalty::given(problem.experiment, best);
        let penalized = |fit: &Fit| fit.cost + penalty.of_all(&fit.estimate);
        penalized(fit) - self.reduction + self.cost(penalty) < penalized(best)
    }

    /// Cost reduction that free constants need. As for an effect, it includes that at the smallest accepted detectability.
    fn cost(&self, penalty: Penalty) -> f64 {
        penalty.minimum() + penalty.unit * self.needed_ratio
    }
}

/// Comparison of a fit with free constants and fits with the declared ones.
pub(crate) struct Comparison<'a> {
    problem: Problem<'a>,
    free: &'a Fit,
    freed: FreedConstants,
}

impl<'a> Comparison<'a> {
    /// With a fit with free constants.
    pub fn new(problem: Problem<'a>, free: &'a Fit) -> Self {
        Self {
            freed: FreedConstants::at(problem, free),
            problem,
            free,
        }
    }

    /// Whether a search that adds effects to a fit with the declared constants can still win: the effects that it has cost
    /// less than the effects and constants of the free fit.
    pub fn is_open(&self, declared: &Fit) -> bool {
        let penalty = Penalty::given(self.problem.experiment, self.free);
        let of_free = penalty.of_all(&self.free.estimate) + self.freed.cost(penalty);
        penalty.of_all(&declared.estimate) < of_free + (self.free.cost - declared.cost).max(0.0)
    }

    /// Probability that the constants are off.
    ///
    /// The penalised costs of effects and constants decide. Constants that leave a lack of fit where they act may be the
    /// closest match to physics outside the catalogue: see [`plausibility`]. Constants at the end of their tolerances
    /// explain nothing.
    pub fn probability_off(&self, declared: &Fit) -> f64 {
        let constants = self.free.estimate.constants.as_ref();
        if constants.is_some_and(FreeConstants::is_at_an_end) {
            return 0.0;
        }
        let better = match self.free.cost < declared.cost {
            true => self.free,
            false => declared,
        };
        let penalty = Penalty::given(self.problem.experiment, better);
        let penalized = |fit: &Fit| {
            fit.cost_under_weights_of(self.problem, better) + penalty.of_all(&fit.estimate)
        };
        let with_constants = penalized(self.free) + self.freed.cost(penalty);
        let log_odds = 0.5 * (penalized(declared) - with_constants) / penalty.unit;
        plausibility(self.freed.explained_share) / (1.0 + (-log_odds).exp())
    }
}

/// The rows and columns `kept` of a symmetric matrix, with `others` eliminated.
fn schur_complement(matrix: &DMatrix<f64>, kept: &[usize], others: &[usize]) -> DMatrix<f64> {
    let part = |rows: &[usize], columns: &[usize]| matrix.select_rows(rows).select_columns(columns);
    let own = part(kept, kept);
    let coupling = part(others, kept);
    let mut eliminated = part(others, others);
    for k in 0..others.len() {
        eliminated[(k, k)] += 1e-9;
    }
    match eliminated.cholesky() {
        Some(root) => own - coupling.transpose() * root.solve(&coupling),
        None => own,
    }
}

/// Logarithm of the determinant of a positive definite matrix.
fn log_determinant(matrix: &DMatrix<f64>) -> f64 {
    let values = matrix.clone().symmetric_eigenvalues();
    values.iter().map(|value| value.max(1.0).ln()).sum()
}

#[cfg(test)]
mod tests {
    use super::{log_determinant, schur_complement};
    use nalgebra::DMatrix;

    /// The determinant of a matrix is that of its eliminated part times that of the complement.
    #[test]
    fn determinants_multiply() {
        let root = DMatrix::from_fn(4, 4, |i, j| match i.cmp(&j) {
            std::cmp::Ordering::Equal => 2.0 + i as f64,
            std::cmp::Ordering::Greater => 0.3 * (i + 2 * j) as f64,
            std::cmp::Ordering::Less => 0.0,
        });
        let matrix = &root * root.transpose();
        let complement = schur_complement(&matrix, &[0, 2], &[1, 3]);
        let eliminated = matrix.select_rows(&[1, 3]).select_columns(&[1, 3]);
        let product = complement.determinant() * eliminated.determinant();
        assert!((product / matrix.determinant() - 1.0).abs() < 1e-6);
        let logarithm = log_determinant(&DMatrix::from_diagonal_element(3, 3, 2.0));
        assert!((logarithm - 3.0 * 2f64.ln()).abs() < 1e-12);
    }
}
