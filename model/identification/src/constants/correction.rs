//! A model with corrections of its constants and sensors applied.

use hitch_plant::{AddedEffect, Constants, Model, Valve, ValveCurve};
use nalgebra::DVector;

use crate::constants::parameter::Parameter;

/// The declared model with its constants corrected. Flow curves stay monotone. `None` if the dimensions make no linkage.
pub fn corrected(
    declared: &Model,
    parameters: &[Parameter],
    theta: &DVector<f64>,
) -> Option<Model> {
    let constants = corrected_constants(declared.constants(), parameters, theta);
    declared.with_constants(constants).ok()
}

/// Effects with the errors of the sensors.
pub fn with_sensor_errors(
    mut effects: Vec<AddedEffect>,
    parameters: &[Parameter],
    theta: &DVector<f64>,
) -> Vec<AddedEffect> {
    for (parameter, &value) in parameters.iter().zip(theta.iter()) {
        if let Parameter::Sensor(sensor) = parameter
            && value != 0.0
        {
            add_sensor_error(&mut effects, sensor.effect, value);
        }
    }
    effects
}

/// Adds an error of a sensor to the declared one, or to none.
fn add_sensor_error(effects: &mut Vec<AddedEffect>, id: &str, error: f64) {
    if let Some(declared) = effects.iter_mut().find(|added| added.effect.id() == id) {
        declared.values[0] += error;
    } else if let Some(effect) = hitch_effects::find(id) {
        let mut added = AddedEffect::typical(effect);
        added.values[0] = error;
        effects.push(added);
    }
}

fn corrected_constants(
    declared: &Constants,
    parameters: &[Parameter],
    theta: &DVector<f64>,
) -> Constants {
    let mut constants = declared.clone();
    for (parameter, &value) in parameters.iter().zip(theta.iter()) {
        if let Parameter::Scalar(constant, _) = parameter {
            *(constant.place)(&mut constants) *= value.exp();
        }
    }
    for valve in Valve::BOTH {
        let curve = curve(&valve.of(declared).curve, valve, parameters, theta);
        valve.of_mut(&mut constants).curve = curve;
    }
    constants
}

fn curve(
    declared: &ValveCurve,
    valve: Valve,
    parameters: &[Parameter],
    theta: &DVector<f64>,
) -> ValveCurve {
    let mut flows = declared.flows_m3_s().to_vec();
    let mut currents = declared.currents_a().to_vec();
    let mut shift_a = 0.0;
    for (parameter, &value) in parameters.iter().zip(theta.iter()) {
        match *parameter {
            Parameter::Flow(of, point) if of == valve => flows[point] *= value.exp(),
            Parameter::Threshold(of) if of == valve => shift_a = value,
            _ => {}
        }
    }
    if shift_a == 0.0 && flows == declared.flows_m3_s() {
        return declared.clone();
    }
    // A point at zero current is not shifted.
    let moved = usize::from(currents[0] == 0.0);
    let shift_a = f64::max(shift_a, -0.9 * currents[moved]);
    currents[moved..]
        .iter_mut()
        .for_each(|current| *current += shift_a);
    for point in 1..flows.len() {
        flows[point] = flows[point].max(flows[point - 1]);
    }
    ValveCurve::new(currents, flows).unwrap_or_else(|_| declared.clone())
}
