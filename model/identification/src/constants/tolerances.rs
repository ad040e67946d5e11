//! Tolerances that a user knows better than the data sheets' usual ones.

use std::collections::BTreeMap;

use hitch_plant::{Constants, Model};
use nalgebra::DVector;

use crate::constants::correction::corrected;
use crate::constants::parameter::{Parameter, parameters};

/// Bound of a coordinate, in prior sigmas: a larger error is outside the tolerances of data sheets, or the accuracy of any
/// model.
pub const FARTHEST_SIGMAS: f64 = 3.0;

/// Own standard deviations of constants, by their names in a model file (`table.key`): a share of a constant or of a flow
/// curve, ampere for the currents of a curve. Zero makes a constant exact.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tolerances(BTreeMap<String, f64>);

impl Tolerances {
    /// Makes a constant exact.
    ///
    /// # Errors
    /// A fit does not move it.
    pub fn hold(&mut self, name: &str, constants: &Constants) -> Result<(), String> {
        named(name, constants)?;
        self.set(name, 0.0);
        Ok(())
    }

    /// Gives a constant a standard deviation, as in [`Tolerances`].
    pub fn set(&mut self, name: &str, sigma: f64) {
        self.0.insert(name.to_owned(), sigma);
    }

    /// Keeps a constant between two values, in the unit of its key; the currents of a curve by its threshold. The model
    /// starts in their middle, from which they are as far as a fit may go.
    ///
    /// # Errors
    /// The constant is not known or has no bounds, or they are not two rising positive values.
    pub fn bound(
        &mut self,
        name: &str,
        [low, high]: [f64; 2],
        model: &Model,
    ) -> Result<Model, String> {
        let parameter = named(name, model.constants())?;
        if !(low > 0.0 && high > low && high.is_finite()) {
            return Err(format!(
                "{low} to {high} are not two rising values above zero"
            ));
        }
        let declared = declared(&parameter, model.constants())
            .ok_or("a curve has no single value; give it a tolerance in percent")?;
        let (half, shift) = match parameter {
            Parameter::Threshold(_) => (0.5 * (high - low), 0.5 * (high + low) - declared),
            _ => (
                0.5 * (high / low).ln(),
                ((high * low).sqrt() / declared).ln(),
            ),
        };
        self.set(name, half / FARTHEST_SIGMAS);
        corrected(model, &[parameter], &DVector::from_element(1, shift))
            .ok_or_else(|| format!("no linkage has {low} to {high}"))
    }

    /// The standard deviation of a constant from a value in the unit of its key, or from a share of it.
    ///
    /// # Errors
    /// The constant is not known, or has no unit in which a tolerance could be given.
    pub fn sigma_of(name: &str, value: Own, constants: &Constants) -> Result<f64, String> {
        let parameter = named(name, constants)?;
        match (parameter, value, declared(&parameter, constants)) {
            (Parameter::Threshold(_), Own::Value(ampere), _) => Ok(ampere),
            (Parameter::Threshold(_), Own::Share(share), Some(declared)) => Ok(share * declared),
            (_, Own::Share(share), _) => Ok(share),
            (_, Own::Value(value), Some(declared)) => Ok(value / declared),
            (_, Own::Value(_), None) => Err("give the tolerance of a curve in percent".to_owned()),
        }
    }

    /// The unknowns of a model that are not exact.
    #[must_use]
    pub fn unknowns(&self, declared: &Constants) -> Vec<Parameter> {
        let mut all = parameters(declared);
        all.retain(|one| self.own(one) != Some(0.0));
        all
    }

    /// Own standard deviation of an unknown.
    #[must_use]
    pub fn own(&self, parameter: &Parameter) -> Option<f64> {
        self.0.get(&parameter.name()?).copied()
    }
}

/// A tolerance as a user gives it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Own {
    /// In the unit of the key.
    Value(f64),
    /// A share of the declared value.
    Share(f64),
}

/// The first unknown of a name.
fn named(name: &str, constants: &Constants) -> Result<Parameter, String> {
    let mut all = parameters(constants).into_iter();
    let found = all.find(|one| one.name().as_deref() == Some(name));
    found.ok_or_else(|| unknown(constants))
}

fn unknown(constants: &Constants) -> String {
    let mut known: Vec<String> = Vec::new();
    for parameter in parameters(constants) {
        known.extend(parameter.name().filter(|name| !known.contains(name)));
    }
    format!("no constant that is fitted; there are {}", known.join(", "))
}

/// Declared value in the unit of the key: the threshold of a curve, none for its flows.
pub(super) fn declared(parameter: &Parameter, constants: &Constants) -> Option<f64> {
    match parameter {
        Parameter::Scalar(constant, _) => {
            Some(*(constant.place)(&mut constants.clone()) / constant.unit)
        }
        Parameter::Threshold(valve) => Some(valve.of(constants).curve.threshold_a()),
        Parameter::Sensor(_) | Parameter::Flow(..) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::free::FreeConstants;

    fn bore_mm(model: &Model) -> f64 {
        1e3 * model.constants().cylinder.bore_m
    }

    #[test]
    fn a_bounded_constant_reaches_its_bounds_and_no_further() {
        let declared = hitch_model_file::nominal();
        let mut own = Tolerances::default();
        let middle = own
            .bound("cylinder.bore_mm", [70.0, 90.0], &declared)
            .unwrap();
        let mut free = FreeConstants::with(&middle, &own);
        let mut reached = [f64::INFINITY, 0.0];
        for coordinate in 0..free.free() {
            for error in [-100.0, 100.0] {
                free.set(coordinate, error);
                let [low, high] = reached;
                let bore_mm = bore_mm(&free.corrected(Vec::new()));
                reached = [low.min(bore_mm), high.max(bore_mm)];
                free.set(coordinate, 0.0);
            }
        }
        assert!(
            (reached[0] - 70.0).abs() < 1e-6 && (reached[1] - 90.0).abs() < 1e-6,
            "{reached:?}"
        );
    }

    #[test]
    fn a_held_constant_is_no_unknown() {
        let declared = hitch_model_file::dynamic();
        let mut own = Tolerances::default();
        own.hold("oil.bulk_modulus_pa", declared.constants())
            .unwrap();
        let all = parameters(declared.constants()).len();
        assert_eq!(own.unknowns(declared.constants()).len(), all - 1);
    }

    #[test]
    fn what_cannot_be_bounded_is_refused() {
        let declared = hitch_model_file::nominal();
        let mut own = Tolerances::default();
        for (name, bounds) in [
            ("cylinder.bore", [1.0, 2.0]),
            ("lift_valve.flow_lpm", [1.0, 2.0]),
            ("cylinder.bore_mm", [90.0, 80.0]),
        ] {
            assert!(own.bound(name, bounds, &declared).is_err(), "{name}");
        }
    }
}
