//! The numbers of a plant by name: its constants and the parameters of its effects, in the units of a model file.

use hitch_plant::{LinkageError, Model};

use crate::constants::{Constant, Variant};
use crate::meaning::meaning_of;

/// A number of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Scalar {
    /// Its table, or the id of its effect, and its key: `pump.theoretical_flow_lpm`.
    pub name: String,
    /// Short description.
    pub meaning: String,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// Its value, in its unit.
    pub value: f64,
    /// Smallest allowed value.
    pub low: f64,
    /// Largest allowed value.
    pub high: f64,
}

/// Tables of constants on which the plant does not depend: its inputs are the currents, and it has no noise.
const NOT_OF_THE_PLANT: [&str; 3] = ["solenoid", "loads", "sensors"];

fn constants_of_the_plant(variant: Variant) -> impl Iterator<Item = &'static Constant> {
    variant
        .constants()
        .filter(|constant| !NOT_OF_THE_PLANT.contains(&constant.table))
}

/// The constants of a model's plant except its flow curves, then the parameters of its effects, in the order of a model file.
#[must_use]
pub fn scalars(model: &Model) -> Vec<Scalar> {
    let mut constants = model.constants().clone();
    let mut scalars: Vec<Scalar> = constants_of_the_plant(Variant::of(&constants))
        .map(|constant| of_constant(constant, *(constant.place)(&mut constants)))
        .collect();
    for added in &model.effects {
        let parameters = added.effect.parameters().iter().zip(&added.values);
        scalars.extend(parameters.map(|(parameter, &value)| Scalar {
            name: format!("{}.{}", added.effect.id(), parameter.key),
            meaning: format!("{}: {}", added.effect.title(), parameter.meaning),
            unit: parameter.unit,
            value,
            low: parameter.low,
            high: parameter.high,
        }));
    }
    scalars
}

fn of_constant(constant: &Constant, si: f64) -> Scalar {
    let meaning = meaning_of(constant.table, constant.key);
    Scalar {
        name: constant.name(),
        meaning: meaning.map_or_else(String::new, |meaning| meaning.what.to_owned()),
        unit: constant.unit_text(),
        value: si / constant.unit,
        low: *constant.range.start(),
        high: *constant.range.end(),
    }
}

/// The model with other values of its [`scalars`], in their order. A value that is not changed keeps every bit.
///
/// # Errors
/// If the dimensions make no linkage.
pub fn with_scalars(model: &Model, values: &[f64]) -> Result<Model, LinkageError> {
    let before = scalars(model);
    let mut changes = before.iter().zip(values);
    let mut constants = model.constants().clone();
    let variant = Variant::of(&constants);
    let count = constants_of_the_plant(variant).count();
    for (constant, (scalar, &value)) in constants_of_the_plant(variant).zip(&mut changes) {
        if value != scalar.value {
            *(constant.place)(&mut constants) = value * constant.unit;
        }
    }
    let mut effects = model.effects.clone();
    let places = effects.iter_mut().flat_map(|added| &mut added.values);
    for (place, &value) in places.zip(&values[count.min(values.len())..]) {
        *place = value;
    }
    Ok(model.with_constants(constants)?.with_effects(effects))
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_plant::AddedEffect;

    fn model() -> Model {
        let model = crate::dynamic();
        let effect = hitch_effects::find("coulomb-friction").unwrap();
        model.with_effects(vec![AddedEffect::typical(effect)])
    }

    #[test]
    fn unchanged_scalars_leave_the_model_bit_for_bit() {
        let model = model();
        let values: Vec<f64> = scalars(&model).iter().map(|scalar| scalar.value).collect();
        let same = with_scalars(&model, &values).unwrap();
        assert_eq!(crate::to_toml(&same), crate::to_toml(&model));
    }

    #[test]
    fn constants_and_effects_change_by_name() {
        let model = model();
        let all = scalars(&model);
        let changed = |name: &str, value: f64| {
            let values = all.iter().map(|scalar| {
                if scalar.name == name {
                    value
                } else {
                    scalar.value
                }
            });
            with_scalars(&model, &values.collect::<Vec<f64>>())
        };
        let pump = changed("pump.theoretical_flow_lpm", 30.0).unwrap();
        assert!((pump.constants().pump.theoretical_flow_m3_s - 0.5e-3).abs() < 1e-12);
        let friction = all.last().unwrap();
        assert_eq!(friction.name.split_once('.').unwrap().0, "coulomb-friction");
        let changed_friction = changed(&friction.name, 77.0).unwrap();
        assert_eq!(changed_friction.effects[0].values.last(), Some(&77.0));
        assert!(changed("linkage.connecting_rod_m", 0.01).is_err());
    }

    #[test]
    fn units_come_from_the_keys() {
        for scalar in scalars(&model()) {
            assert!(
                hitch_input::unit::Unit::parse(scalar.unit).is_ok(),
                "{scalar:?}"
            );
            let pure = ["volumetric_efficiency"]
                .iter()
                .any(|end| scalar.name.ends_with(end));
            assert_eq!(scalar.unit.is_empty(), pure, "{scalar:?}");
            assert!(
                (scalar.low..=scalar.high).contains(&scalar.value),
                "{scalar:?}"
            );
        }
    }
}
