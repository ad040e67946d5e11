//! Prior of the unknowns: data-sheet tolerances, and smooth errors of the flow curves.

use hitch_plant::Constants;
use nalgebra::{DMatrix, DVector};

use crate::constants::parameter::{Parameter, THRESHOLD_SIGMA_A};
use crate::constants::tolerances::FARTHEST_SIGMAS;
use crate::constants::tolerances::Tolerances;

/// Standard deviation of the error that all points of a flow curve share, and of the one that varies over the current:
/// 20 % together.
const SHARED: f64 = 0.14;
const CHANGING: f64 = 0.14;

/// Correlation length of a curve's error over the current, as a share of the range from threshold to current limit.
const REACH: f64 = 0.3;

/// Standard deviation of a single point: reading error of a printed curve.
const SINGLE: f64 = 0.02;

/// Gaussian prior about the declared values.
#[derive(Debug, Clone)]
pub struct Prior {
    /// One sigma of each unknown.
    pub sigma: Vec<f64>,
    /// Their covariance.
    pub covariance: DMatrix<f64>,
}

impl Prior {
    /// The prior of a model's unknowns, with a user's own tolerances.
    pub fn new(declared: &Constants, parameters: &[Parameter], own: &Tolerances) -> Self {
        let size = parameters.len();
        let factor = |one: &Parameter| own.own(one).map_or(1.0, |sigma| sigma / usual_sigma(*one));
        let factors: Vec<f64> = parameters.iter().map(factor).collect();
        let covariance = DMatrix::from_fn(size, size, |i, j| {
            factors[i] * factors[j] * covariance(declared, parameters[i], parameters[j], i == j)
        });
        let sigma = (0..size).map(|k| covariance[(k, k)].sqrt()).collect();
        Self { sigma, covariance }
    }

    /// Whether an unknown is at its bound.
    pub fn is_at_an_end(&self, theta: &DVector<f64>, unknown: usize) -> bool {
        theta[unknown].abs() >= 0.999 * FARTHEST_SIGMAS * self.sigma[unknown]
    }
}

/// One sigma of an unknown by the tolerances of data sheets.
pub fn usual_sigma(parameter: Parameter) -> f64 {
    match parameter {
        Parameter::Scalar(_, tolerance) => tolerance.sigma,
        Parameter::Sensor(sensor) => sensor.tolerance,
        Parameter::Threshold(_) => THRESHOLD_SIGMA_A,
        Parameter::Flow(..) => SHARED.hypot(CHANGING).hypot(SINGLE),
    }
}

fn covariance(declared: &Constants, a: Parameter, b: Parameter, same: bool) -> f64 {
    match (a, b) {
        (Parameter::Flow(valve, i), Parameter::Flow(other, j)) if valve == other => {
            let curve = &valve.of(declared).curve;
            let currents_a = curve.currents_a();
            let range_a = currents_a[currents_a.len() - 1] - curve.threshold_a();
            let apart = (currents_a[i] - currents_a[j]) / (REACH * range_a);
            let single = if same { SINGLE * SINGLE } else { 0.0 };
            SHARED * SHARED + CHANGING * CHANGING * (-0.5 * apart * apart).exp() + single
        }
        _ if same => usual_sigma(a).powi(2),
        _ => 0.0,
    }
}
