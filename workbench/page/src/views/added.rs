//! The effects of the present model, with the range of each parameter.

use hitch_identification::estimate::Estimate;
use hitch_plant::{AddedEffect, Parameter};
use schemars::JsonSchema;
use serde::Serialize;

use super::effect_texts::EffectTexts;

/// An effect of the present model.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ShownEffect {
    /// Its texts.
    pub effect: EffectTexts,
    /// Its parameters.
    pub parameters: Vec<ShownParameter>,
}

/// A parameter with the range of its slider; values in its unit.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ShownParameter {
    /// Whether it keeps its value in fits.
    pub fixed: bool,
    /// Name.
    pub name: &'static str,
    /// Unit; empty for a pure number.
    pub unit: &'static str,
    /// Meaning.
    pub meaning: &'static str,
    /// Value.
    pub value: f64,
    /// Lower end of the range; `null` without one.
    #[schemars(with = "Option<f64>")]
    pub low: f64,
    /// Upper end of the range; `null` without one.
    #[schemars(with = "Option<f64>")]
    pub high: f64,
    /// Size of a typical change.
    pub scale: f64,
    /// Whether changes are relative to its value.
    pub by_magnitude: bool,
}

impl ShownEffect {
    /// The effects of an estimate.
    pub fn all(estimate: &Estimate) -> Vec<Self> {
        let effect = |added: &AddedEffect| {
            let id = added.effect.id();
            let parameters = added.effect.parameters().iter().zip(&added.values);
            let shown = parameters.enumerate().map(|(index, (parameter, value))| {
                let fixed = estimate.fixed.contains(&(id, index));
                ShownParameter::of(parameter, *value, fixed)
            });
            Self {
                effect: EffectTexts::of(added.effect),
                parameters: shown.collect(),
            }
        };
        estimate.effects.iter().map(effect).collect()
    }
}

impl ShownParameter {
    fn of(parameter: &Parameter, value: f64, fixed: bool) -> Self {
        Self {
            fixed,
            name: parameter.name,
            unit: parameter.unit,
            meaning: parameter.meaning,
            value,
            low: parameter.low,
            high: parameter.high,
            scale: parameter.scale(),
            by_magnitude: parameter.is_by_magnitude(),
        }
    }
}
