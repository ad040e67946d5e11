//! Evidence that the constants of the declared model are off.
//!
//! Two hypotheses are compared: the declared constants are as exact as those of any model, or they differ from the machine
//! within a share of the tolerances of data sheets. Their marginal likelihoods (Laplace's approximation) differ by the
//! reduction of the cost that free constants bring, less the logarithm of the factor by which the campaign narrows their
//! prior: constants that the campaign determines have to explain much to be worth it.

use nalgebra::DMatrix;

use crate::constants::free::FreeConstants;
use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::fit::{Fit, refine};
use crate::estimation::nuisance_projection::NuisanceProjection;
use crate::estimation::residual_columns::{difference, huber_residuals};
use crate::selection::candidate::{explained_share, plausibility};
use crate::selection::complexity_penalty::Penalty;
use crate::selection::constants_cost::{ConstantsCost, least_share};
use crate::selection::constants_sensitivities::Sensitivities;

/// The free constants of a fit.
#[derive(Debug, Clone)]
struct FreedConstants {
    /// One sigma of their prior, in tolerances.
    share: f64,
    /// The cost over their errors.
    cost: ConstantsCost,
    /// Share of the mean square beyond noise that their present values explain: see [`explained_share`].
    explained_share: f64,
}

/// Mean square error of the constants of a fit, in units of the prior's. `None` if they are not free, or the covariance is
/// singular.
///
/// The covariance is a sandwich: the scatter of the slopes of the cost between stretches of the campaign, between the curvatures
/// (Huber 1967, White 1982). A misfit of the model pulls at the constants in each stretch differently, more than noise does. The
/// step that the whole slope still asks for is added: a hitch that comes to its stop just so, or not, is a step of the cost, at
/// which a descent may end before its minimum.
pub(crate) fn covariance(problem: Problem<'_>, fit: &Fit) -> Option<DMatrix<f64>> {
    fit.estimate.constants.as_ref()?;
    let unit = Penalty::given(problem.experiment, fit).unit;
    let sensitivities = Sensitivities::at(problem, fit);
    let (precision, pull) = sensitivities.normal_equations();
    let size = precision.nrows();
    let root = precision.cholesky()?;
    let step = root.solve(&pull);
    // The prior of the fit is narrower by the unit: see `shares`.
    let scatter =
        sensitivities.scatter_of_slopes(problem.experiment) + DMatrix::identity(size, size) * unit;
    let inverse = root.inverse();
    Some(&inverse * scatter * &inverse + &step * step.transpose())
}

impl FreedConstants {
    /// At a fit with free constants.
    fn at(problem: Problem<'_>, fit: &Fit) -> Self {
        let sensitivities = Sensitivities::at(problem, fit);
        let Sensitivities {
            estimate,
            residuals,
            jacobian,
        } = &sensitivities;
        let is_constant = |column: usize| sensitivities.is_constant(column);
        let others = NuisanceProjection::keeping(jacobian, estimate, |k| !is_constant(k));
        let declared = Estimate {
            constants: None,
            ..estimate.clone()
        };
        let without = huber_residuals(problem, &fit.weights, &declared);
        let (changes, _) = others.project_within_range(difference(&without, residuals));
        let share = estimate
            .constants
            .as_ref()
            .map_or(1.0, FreeConstants::share);
        Self {
            share,
            cost: ConstantsCost::of(&sensitivities),
            explained_share: explained_share(problem.experiment, &changes, residuals),
        }
    }

    /// Cost reduction that they need.
    fn price(&self, penalty: Penalty) -> f64 {
        self.cost.price(self.share, penalty)
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
        let of_free = penalty.of_all(&self.free.estimate) + self.freed.price(penalty);
        penalty.of_all(&declared.estimate) < of_free + (self.free.cost - declared.cost).max(0.0)
    }

    /// Probability that the constants are off.
    ///
    /// The penalised costs of effects and constants decide; the declared constants may be off by the accuracy of any model,
    /// too. Constants that leave a lack of fit where they act may be the
    /// closest match to physics outside the catalogue: see [`plausibility`]. Constants at the end of their tolerances
    /// explain nothing.
    pub fn probability_off(&self, declared: &Fit) -> f64 {
        let constants = self.free.estimate.constants.as_ref();
        if constants.is_some_and(FreeConstants::is_at_an_end) {
            return 0.0;
        }
        let start = declared.estimate.clone();
        let penalty = Penalty::given(self.problem.experiment, self.free);
        let start = start.with_free_constants(self.problem.model, least_share(penalty));
        let inaccurate = refine(self.problem, start);
        let better = if self.free.cost < inaccurate.cost {
            self.free
        } else {
            &inaccurate
        };
        let penalty = Penalty::given(self.problem.experiment, better);
        let [declared, free] = inaccurate.compared(self.free);
        let declared = declared + penalty.of_all(&inaccurate.estimate);
        let free = free + penalty.of_all(&self.free.estimate) + self.freed.price(penalty);
        let log_odds = 0.5 * (declared - free) / penalty.unit;
        plausibility(self.freed.explained_share) / (1.0 + (-log_odds).exp())
    }
}
