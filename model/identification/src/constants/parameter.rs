//! Unknowns of a fit of the base model, and the tolerances of data sheets.

use hitch_model_file::{Constant, Role, Tolerance, fitted_constants};
use hitch_plant::{Constants, Dynamics, Valve};

/// Tolerance of a threshold current, A, one sigma: coil, spring and overlap vary between valves.
pub const THRESHOLD_SIGMA_A: f64 = 0.05;

/// Error of a sensor, an effect of the catalogue with one parameter.
#[derive(Debug)]
pub struct Sensor {
    /// The effect's identifier.
    pub effect: &'static str,
    /// Display unit.
    pub unit: &'static str,
    /// One display unit in the unit of the effect's parameter.
    pub size: f64,
    /// Tolerance in the unit of the effect's parameter, one sigma.
    pub tolerance: f64,
}

/// The sensors that a fit of the base model calibrates: a hall sensor has 1 % of gain error, a pressure sensor for
/// 250 bar an offset of 0.4 % of that. A gain of the pressure sensor is not separable from the bore, since the flow
/// curves correct any flow.
#[rustfmt::skip]
pub static SENSORS: [Sensor; 2] = [
    Sensor { effect: "angle-sensor-gain", unit: "%", size: 0.01, tolerance: 0.01 },
    Sensor { effect: "pressure-sensor-offset", unit: "bar", size: 1.0, tolerance: 1.0 },
];

/// One unknown of the fit.
#[derive(Debug, Clone, Copy)]
pub enum Parameter {
    /// Logarithm of a constant over its declared value.
    Scalar(&'static Constant, Tolerance),
    /// Shift of a valve's curve along the current, A.
    Threshold(Valve),
    /// Error of a sensor beyond the declared one, in the unit of its effect.
    Sensor(&'static Sensor),
    /// Logarithm of the flow at a point of a valve's curve, by its index, over the declared one.
    Flow(Valve, usize),
}

impl Parameter {
    /// Whether it is identifiable separately from all others.
    #[must_use]
    pub fn is_separable(&self) -> bool {
        !matches!(self, Self::Scalar(_, tolerance) if tolerance.role == Role::Inseparable)
    }

    /// Its name in a model file, `table.key`; `None` for a sensor, which is an effect.
    #[must_use]
    pub fn name(&self) -> Option<String> {
        match self {
            Self::Scalar(constant, _) => Some(constant.name()),
            Self::Threshold(valve) => Some(format!("{}.current_a", valve.key())),
            Self::Flow(valve, _) => Some(format!("{}.flow_lpm", valve.key())),
            Self::Sensor(_) => None,
        }
    }
}

/// All unknowns of a model. Constants that are zero have no logarithm and stay zero.
#[must_use]
pub fn parameters(declared: &Constants) -> Vec<Parameter> {
    let mut copy = declared.clone();
    let is_dynamic = declared.dynamics == Dynamics::Dynamic;
    let scalars: Vec<Parameter> = fitted_constants()
        .filter(|(_, tolerance)| is_dynamic || tolerance.role != Role::Dynamic)
        .filter(|(constant, _)| *(constant.place)(&mut copy) > 0.0)
        .map(|(constant, tolerance)| Parameter::Scalar(constant, tolerance))
        .collect();
    let valves = Valve::BOTH;
    let thresholds = valves.map(Parameter::Threshold);
    let flows = valves.into_iter().flat_map(|valve| {
        let curve = &valve.of(declared).curve;
        let points = curve.flows_m3_s().iter().enumerate();
        let open: Vec<usize> = points
            .filter(|(_, flow)| **flow > 0.0)
            .map(|(point, _)| point)
            .collect();
        open.into_iter()
            .map(move |point| Parameter::Flow(valve, point))
    });
    scalars.into_iter().chain(thresholds).chain(flows).collect()
}
