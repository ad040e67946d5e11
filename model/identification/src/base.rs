//! Fit of the base model: the constants of its components, before any effect is added.
//!
//! Every constant has a prior ([`crate::constants`]). The flow curves of both valves are corrected point by point. Clocks
//! and loads are fitted as for effects. Constants that a campaign cannot determine keep their declared values and are listed.

use hitch_plant::{Model, Valve};
use nalgebra::DVector;

use crate::constants::fitted::Posterior;
pub use crate::constants::fitted::{CurvePoint, FittedConstant};
use crate::constants::free::FreeConstants;
use crate::constants::parameter::{Parameter, SENSORS};
use crate::constants::tolerances::Tolerances;
use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::fit::{Fit, fit, refine};
use crate::explanation::explain::fit_base;
use crate::selection::constants_evidence::covariance;

/// Smallest error of a sensor, in sigmas, that becomes an effect of the model.
const SIGNIFICANT: f64 = 3.0;

/// The base model fitted to a campaign.
#[derive(Debug, Clone)]
pub struct BaseFit {
    /// The fitted model, with the effects of the declared one and determined errors of the sensors.
    pub model: Model,
    /// The declared model with loads and clocks fitted.
    pub before: Fit,
    /// The fitted model with loads and clocks fitted.
    pub after: Fit,
    /// The constants.
    pub constants: Vec<FittedConstant>,
    /// The flow curves, point by point.
    pub curves: Vec<CurvePoint>,
}

/// Fits the constants of a model to a campaign, within a user's own tolerances; `say` receives the current task.
///
/// The first fit frees all constants and both sensors. It says what the campaign determines. The second fit frees only that:
/// a sensor without an error would take up errors of the model.
#[must_use]
pub fn fit_base_model(
    experiment: &Experiment,
    declared: &Model,
    own: &Tolerances,
    say: &dyn Fn(&str),
) -> BaseFit {
    let problem = Problem::new(experiment, declared);
    let before = fit_base(problem);
    let mut all = own.unknowns(declared.constants());
    all.extend(SENSORS.iter().map(Parameter::Sensor));
    let fitted = |free: &[usize]| {
        let unknowns = free.iter().map(|&k| all[k]).collect();
        let start = FreeConstants::among(declared, unknowns, own);
        let found = fit(
            problem,
            Estimate {
                constants: Some(start.clone()),
                ..before.estimate.clone()
            },
        );
        let constants = found.estimate.constants.clone().unwrap_or(start);
        let mut errors = DVector::zeros(all.len());
        for (&k, error) in free.iter().zip(constants.errors_of_unknowns()) {
            errors[k] = *error;
        }
        (found, constants, errors)
    };
    say("all constants");
    let separable = |&k: &usize| all[k].is_separable();
    let free: Vec<usize> = (0..all.len()).filter(separable).collect();
    let (found, constants, errors) = fitted(&free);
    let listed = FreeConstants::among(declared, all.clone(), own);
    let mut posterior = listed.prior();
    if let Some(covariance) = covariance(problem, &found) {
        for (&k, known) in free.iter().zip(constants.posterior(&covariance)) {
            posterior[k] = known;
        }
    }
    let known = known(&all, &errors, &posterior);
    say("the constants that the campaign determines");
    let (found, _, errors) = fitted(&known);
    let model = found.estimate.applied_to(declared);
    let estimate = Estimate {
        effects: model.effects.clone(),
        constants: None,
        ..found.estimate
    };
    let after = refine(Problem::new(experiment, &model), estimate.with_adopted());
    let (constants, curves) = listed.fitted(&model, &errors, &posterior);
    BaseFit {
        model,
        before,
        after,
        constants,
        curves,
    }
}

/// Indices of the unknowns that the campaign determines: constants, curves with a determined point, and sensors with an
/// error.
fn known(all: &[Parameter], errors: &DVector<f64>, posterior: &[Posterior]) -> Vec<usize> {
    let is_determined = |k: usize| posterior[k].determined;
    let any_point = |valve: Valve| {
        let is_point = |k: &usize| matches!(all[*k], Parameter::Flow(of, _) if of == valve);
        (0..all.len()).filter(is_point).any(is_determined)
    };
    let is_known = |k: &usize| match all[*k] {
        Parameter::Flow(valve, _) => any_point(valve),
        Parameter::Scalar(..) | Parameter::Threshold(_) => is_determined(*k),
        Parameter::Sensor(_) => {
            is_determined(*k) && errors[*k].abs() > SIGNIFICANT * posterior[*k].sigma
        }
    };
    (0..all.len()).filter(is_known).collect()
}
