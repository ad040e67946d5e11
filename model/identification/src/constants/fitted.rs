//! Corrections of the constants as values with intervals, for reports.

use hitch_plant::units::lpm_from_m3_s;
use hitch_plant::{Model, Valve};
use nalgebra::DVector;

use crate::constants::parameter::Parameter;
use crate::constants::prior::Prior;

/// Ratio of posterior to prior sigma below which a constant counts as determined.
pub(crate) const DETERMINED: f64 = 0.7;

/// Relative standard deviation of a constant that no campaign can improve: errors of tables, areas and integration.
pub(crate) const MODEL_ERROR: f64 = 0.002;

/// Half width of a 95 % interval, in sigmas.
const INTERVAL: f64 = 1.96;

/// A constant with its estimate.
#[derive(Debug, Clone)]
pub struct FittedConstant {
    /// `table.key` of a model file; for a threshold, the table and `threshold_a`.
    pub name: String,
    /// Unit.
    pub unit: &'static str,
    /// Declared value.
    pub declared: f64,
    /// Fitted value; the declared one if it is not determined.
    pub fitted: f64,
    /// One sigma of the tolerance, in the unit.
    pub tolerance: f64,
    /// 95 % interval, from data sheet and campaign.
    pub interval: (f64, f64),
    /// Whether the campaign determines it.
    pub determined: bool,
    /// Whether it is at the bound of its accepted range.
    pub at_an_end: bool,
}

/// A point of a flow curve.
#[derive(Debug, Clone)]
pub struct CurvePoint {
    /// The valve.
    pub valve: Valve,
    /// Fitted current, A.
    pub current_a: f64,
    /// Declared flow at the reference drop, l/min.
    pub declared_lpm: f64,
    /// Fitted flow, l/min.
    pub fitted_lpm: f64,
    /// 95 % interval of the flow, l/min.
    pub interval_lpm: (f64, f64),
    /// Whether the campaign determines it; if not, it follows its neighbours.
    pub determined: bool,
}

/// What is known of an unknown after a fit.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Posterior {
    /// One sigma.
    pub sigma: f64,
    /// Whether the campaign determines it.
    pub determined: bool,
}

/// Corrections of the constants of a model.
pub(crate) struct Fitted<'a> {
    pub declared: &'a Model,
    pub model: &'a Model,
    pub parameters: &'a [Parameter],
    pub theta: &'a DVector<f64>,
    pub posterior: &'a [Posterior],
    pub prior: &'a Prior,
}

impl Fitted<'_> {
    /// The constants outside the flow curves.
    pub fn constants(&self) -> Vec<FittedConstant> {
        let all = self.parameters.iter().enumerate();
        all.filter_map(|(k, parameter)| self.constant(k, parameter))
            .collect()
    }

    fn constant(&self, k: usize, parameter: &Parameter) -> Option<FittedConstant> {
        let (value, half) = (self.theta[k], INTERVAL * self.posterior[k].sigma);
        let mut tolerance = self.prior.sigma[k];
        let (name, unit, declared, at): (_, _, _, Box<dyn Fn(f64) -> f64>) = match parameter {
            Parameter::Scalar(constant, _) => {
                let si = *(constant.place)(&mut self.declared.constants().clone());
                let declared = si / constant.unit;
                tolerance *= declared;
                let at = move |correction: f64| declared * correction.exp();
                (
                    constant.name(),
                    constant.unit_text(),
                    declared,
                    Box::new(at),
                )
            }
            Parameter::Threshold(valve) => {
                let declared = valve.of(self.declared.constants()).curve.threshold_a();
                let name = format!("{}.threshold_a", valve.key());
                (name, "A", declared, Box::new(move |shift| declared + shift))
            }
            Parameter::Sensor(sensor) => {
                let mut added = self.declared.effects.iter();
                let added = added.find(|added| added.effect.id() == sensor.effect);
                let declared = added.map_or(0.0, |added| added.values[0]) / sensor.size;
                tolerance /= sensor.size;
                let at = move |error: f64| declared + error / sensor.size;
                (
                    sensor.effect.to_owned(),
                    sensor.unit,
                    declared,
                    Box::new(at),
                )
            }
            Parameter::Flow(..) => return None,
        };
        Some(FittedConstant {
            name,
            unit,
            declared,
            fitted: at(value),
            tolerance,
            interval: (at(value - half), at(value + half)),
            determined: self.posterior[k].determined,
            at_an_end: self.prior.is_at_an_end(self.theta, k),
        })
    }

    /// The points of the flow curves.
    pub fn curves(&self) -> Vec<CurvePoint> {
        let all = self.parameters.iter().enumerate();
        all.filter_map(|(k, parameter)| match *parameter {
            Parameter::Flow(valve, point) => Some(self.curve_point(k, valve, point)),
            Parameter::Scalar(..) | Parameter::Threshold(_) | Parameter::Sensor(_) => None,
        })
        .collect()
    }

    fn curve_point(&self, k: usize, valve: Valve, point: usize) -> CurvePoint {
        let curve = |model: &Model| valve.of(model.constants()).curve.clone();
        let (declared, fitted) = (curve(self.declared), curve(self.model));
        let fitted_lpm = lpm_from_m3_s(fitted.flows_m3_s()[point]);
        let factor = (INTERVAL * self.posterior[k].sigma).exp();
        CurvePoint {
            valve,
            current_a: fitted.currents_a()[point],
            declared_lpm: lpm_from_m3_s(declared.flows_m3_s()[point]),
            fitted_lpm,
            interval_lpm: (fitted_lpm / factor, fitted_lpm * factor),
            determined: self.posterior[k].determined,
        }
    }
}
