//! The fit of the base model, and which constants it determined.

use hitch_plant::{Model, Valve};
use nalgebra::{DMatrix, DVector};

use crate::base::descent::descend;
use crate::base::normal::{BaseProblem, Normal, Point, RunColumns, with_effects_of};
use crate::constants::fitted::{CurvePoint, DETERMINED, Fitted, FittedConstant, MODEL_ERROR};
use crate::constants::parameter::{Parameter, SENSORS};
use crate::constants::prior::Prior;
use crate::constants::tolerances::Tolerances;
use crate::data::experiment::Experiment;
use crate::data::problem::Problem;
use crate::estimation::fit::{COARSE, Fit, evaluate_weighted, refine};
use crate::explanation::explain::fit_base;
use crate::residuals::whitening::Weights;
use crate::selection::evidence::variance_inflation;

/// Factor on the tolerances of all other constants in the test whether the campaign determines a constant: one that is
/// determined only by the others' tolerances (a length that trades off against the bore) keeps its declared value.
const WIDER: f64 = 3.0;

/// Smallest error of a sensor, in sigmas, that becomes an effect of the model.
const SIGNIFICANT: f64 = 3.0;

/// Rounds of the fit, each with new weights, and Jacobians per round. The first round relies on flow and angle, as
/// ringing pressures create local minima.
const ROUNDS: usize = 3;
const JACOBIANS: usize = 5;

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
#[must_use]
pub fn fit_base_model(
    experiment: &Experiment,
    declared: &Model,
    own: &Tolerances,
    say: &dyn Fn(&str),
) -> BaseFit {
    let mut parameters = own.unknowns(declared.constants());
    parameters.extend(SENSORS.iter().map(Parameter::Sensor));
    let prior = Prior::new(declared.constants(), &parameters, own);
    let before = fit_base(Problem::new(experiment, declared));
    let inseparable: Vec<bool> = parameters.iter().map(|one| !one.is_separable()).collect();
    let without_sensors: Vec<bool> = parameters
        .iter()
        .map(|one| !one.is_separable() || one.is_sensor())
        .collect();
    let mut problem = BaseProblem {
        experiment,
        declared,
        parameters: &parameters,
        prior: &prior,
        held: &without_sensors,
    };
    let mut point = Point {
        theta: DVector::zeros(parameters.len()),
        estimate: before.estimate.clone(),
        cost: f64::INFINITY,
    };
    for round in 0..ROUNDS {
        say(&format!("constants, round {} of {}", round + 1, ROUNDS + 1));
        point = improved(&problem, point, round == 0);
    }
    say("sensors");
    let found = with_sensors(&problem, &inseparable, point);
    let held = found.held(&parameters);
    let Posterior {
        mut point,
        sigma,
        determined,
    } = found;
    for k in (0..held.len()).filter(|&k| held[k]) {
        point.theta[k] = 0.0;
    }
    problem.held = &held;
    say(&format!("constants, round {0} of {0}", ROUNDS + 1));
    let point = improved(&problem, point, false);
    let model = problem.model(&point.theta);
    let model = model.unwrap_or_else(|| declared.clone());
    let estimate = with_effects_of(&model, point.estimate.clone());
    let after = refine(Problem::new(experiment, &model), estimate);
    let report = Fitted {
        declared,
        model: &model,
        parameters: &parameters,
        theta: &point.theta,
        sigma: &sigma,
        determined: &determined,
        prior: &prior,
    };
    BaseFit {
        constants: report.constants(),
        curves: report.curves(),
        model,
        before,
        after,
    }
}

/// Values of the unknowns, their posterior sigmas, and whether the campaign determines them.
struct Posterior {
    point: Point,
    sigma: Vec<f64>,
    determined: Vec<bool>,
}

impl Posterior {
    fn of(problem: &BaseProblem<'_>, point: Point) -> Self {
        let (sigma, determined) = posterior(problem, &point);
        Self {
            point,
            sigma,
            determined,
        }
    }

    /// Whether a sensor has an error.
    fn has_error(&self, sensor: usize) -> bool {
        let error = self.point.theta[sensor].abs();
        self.determined[sensor] && error > SIGNIFICANT * self.sigma[sensor]
    }

    /// Fixed unknowns: constants that are not determined, curves without any determined point, and sensors without an
    /// error, which would be an effect without meaning.
    fn held(&self, parameters: &[Parameter]) -> Vec<bool> {
        let any_point = |valve: Valve| {
            let mut all = parameters.iter().zip(&self.determined);
            all.any(|(parameter, &determined)| {
                determined && matches!(parameter, Parameter::Flow(of, _) if *of == valve)
            })
        };
        let all = parameters.iter().enumerate();
        all.map(|(k, parameter)| match parameter {
            Parameter::Flow(valve, _) => !any_point(*valve),
            Parameter::Scalar(..) | Parameter::Threshold(_) => !self.determined[k],
            Parameter::Sensor(_) => !self.has_error(k),
        })
        .collect()
    }
}

/// The fit of constants with the sensors free if one of them has an error; else the fit without them. Free sensors
/// without errors would only take up errors of the model.
fn with_sensors(problem: &BaseProblem<'_>, inseparable: &[bool], point: Point) -> Posterior {
    let free = BaseProblem {
        held: inseparable,
        ..*problem
    };
    let mut moved = point.clone();
    for _ in 1..ROUNDS {
        moved = improved(&free, moved, false);
    }
    let moved = Posterior::of(&free, moved);
    let sensors = (0..inseparable.len()).filter(|&k| problem.parameters[k].is_sensor());
    let sensors: Vec<usize> = sensors.collect();
    if sensors.iter().any(|&sensor| moved.has_error(sensor)) {
        return moved;
    }
    let mut kept = Posterior::of(problem, point);
    for sensor in sensors {
        kept.sigma[sensor] = moved.sigma[sensor];
        kept.determined[sensor] = moved.determined[sensor];
    }
    kept
}

/// One round: constants, clocks and loads under new weights, then the search of the clocks.
fn improved(problem: &BaseProblem<'_>, point: Point, coarse: bool) -> Point {
    let Some(model) = problem.model(&point.theta) else {
        return point;
    };
    let estimate = with_effects_of(&model, point.estimate.clone());
    let weights = Weights::new(Problem::new(problem.experiment, &model), &estimate);
    let weights = if coarse {
        weights.scaled(COARSE)
    } else {
        weights
    };
    let mut point = descend(problem, &weights, &point, JACOBIANS);
    if let Some(model) = problem.model(&point.theta) {
        point.estimate = refine(Problem::new(problem.experiment, &model), point.estimate).estimate;
    }
    point
}

/// Posterior sigma of each unknown, from campaign and prior, and whether the campaign determines it. Residuals beyond
/// noise and slow noise reduce the campaign's information.
fn posterior(problem: &BaseProblem<'_>, point: &Point) -> (Vec<f64>, Vec<bool>) {
    let prior = problem.prior;
    let found = problem.model(&point.theta).and_then(|model| {
        let weights = Weights::new(Problem::new(problem.experiment, &model), &point.estimate);
        let columns = problem.columns(&weights, point)?;
        let estimate = point.estimate.clone();
        let fit = evaluate_weighted(Problem::new(problem.experiment, &model), estimate, weights);
        Some((fit, columns))
    });
    let Some((fit, columns)) = found else {
        return (prior.sigma.clone(), vec![false; prior.sigma.len()]);
    };
    let (matrix, _) = Normal::of(&columns).reduced(0.0);
    let unknowns = problem.parameters.iter().enumerate();
    unknowns
        .map(|(unknown, parameter)| {
            let column = |run: &RunColumns| run.columns[unknown].clone();
            let signature: Vec<Vec<f64>> = columns.iter().map(column).collect();
            let inflation = variance_inflation(problem.experiment, &fit.residuals, &signature);
            let information = &matrix / (fit.variance() * inflation);
            let largest = prior.sigma[unknown];
            let precision = problem.precision(&prior.precision);
            let sigma = sigma_of(&information + precision, unknown, largest);
            let alone = if parameter.is_flow() {
                sigma
            } else {
                sigma_of(
                    information + problem.precision(&prior.widened(WIDER, unknown)),
                    unknown,
                    largest,
                )
            };
            (sigma, alone <= DETERMINED * largest)
        })
        .unzip()
}

/// One sigma of an unknown, at most `largest`.
fn sigma_of(information: DMatrix<f64>, unknown: usize, largest: f64) -> f64 {
    let root = information.cholesky();
    let variance = root.map(|root| root.inverse()[(unknown, unknown)] + MODEL_ERROR * MODEL_ERROR);
    variance.map_or(largest, |variance| variance.sqrt().min(largest))
}
