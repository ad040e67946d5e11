//! The constants that a fit moves, as a user sees them.

use hitch_plant::Constants;

use crate::constants::parameter::{Parameter, parameters};
use crate::constants::prior::usual_sigma;
use crate::constants::tolerances::{Own, declared};

/// A constant, or a flow curve, that a fit moves.
#[derive(Debug, Clone, PartialEq)]
pub struct Movable {
    /// Its name in a model file: `table.key`.
    pub name: String,
    /// Unit of its key.
    pub unit: &'static str,
    /// Declared value in that unit, of currents the threshold; `None` for the flows of a curve.
    pub declared: Option<f64>,
    /// Its usual tolerance, one standard deviation.
    pub usual: Own,
}

impl Movable {
    /// The constants that a fit moves, each once.
    #[must_use]
    pub fn all(constants: &Constants) -> Vec<Self> {
        let mut known: Vec<Self> = Vec::new();
        for parameter in parameters(constants) {
            let one = Self::of(&parameter, constants);
            known.extend(one.filter(|one| known.iter().all(|other| other.name != one.name)));
        }
        known
    }

    /// An unknown; `None` for an error of a sensor, which is an effect.
    fn of(parameter: &Parameter, constants: &Constants) -> Option<Self> {
        let sigma = usual_sigma(*parameter);
        let (unit, usual) = match parameter {
            Parameter::Scalar(constant, _) => (constant.unit_text(), Own::Share(sigma)),
            Parameter::Threshold(_) => ("A", Own::Value(sigma)),
            Parameter::Flow(..) => ("l/min", Own::Share(sigma)),
            Parameter::Sensor(_) => return None,
        };
        Some(Self {
            name: parameter.name()?,
            unit,
            declared: declared(parameter, constants),
            usual,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constants::tolerances::Tolerances;

    #[test]
    fn each_constant_is_named_once_and_can_be_held() {
        for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
            let all = Movable::all(model.constants());
            let mut own = Tolerances::default();
            for one in &all {
                own.hold(&one.name, model.constants()).unwrap();
                let same = all.iter().filter(|other| other.name == one.name);
                assert_eq!(same.count(), 1, "{}", one.name);
            }
            assert!(own.unknowns(model.constants()).is_empty());
        }
    }

    #[test]
    fn the_declared_value_is_that_of_the_model_file() {
        let model = hitch_model_file::nominal();
        let all = Movable::all(model.constants());
        let bore = all
            .iter()
            .find(|one| one.name == "cylinder.bore_mm")
            .unwrap();
        assert_eq!(bore.unit, "mm");
        let declared_mm = bore.declared.unwrap();
        assert!((declared_mm - 1e3 * model.constants().cylinder.bore_m).abs() < 1e-9);
    }
}
