//! Texts of an effect.

use hitch_plant::{Effect, Parameter, full_name};
use schemars::JsonSchema;
use serde::Serialize;

/// Texts of an effect.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct EffectTexts {
    /// Name with its form.
    pub name: String,
    /// Id.
    pub id: &'static str,
    /// Title.
    pub title: &'static str,
    /// Equation.
    pub equation: &'static str,
    /// Conditions in which it is visible.
    pub shows: &'static str,
    /// Literature or own work.
    pub source: &'static str,
    /// Meanings of its parameters.
    pub parameters: Vec<ParameterMeaning>,
}

/// A parameter of an effect.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ParameterMeaning {
    /// Name.
    pub name: &'static str,
    /// Meaning.
    pub meaning: &'static str,
}

impl EffectTexts {
    /// The texts of an effect.
    pub fn of(effect: &'static dyn Effect) -> Self {
        let meaning = |parameter: &Parameter| ParameterMeaning {
            name: parameter.name,
            meaning: parameter.meaning,
        };
        Self {
            name: full_name(effect),
            id: effect.id(),
            title: effect.title(),
            equation: effect.equation(),
            shows: effect.shows(),
            source: effect.source(),
            parameters: effect.parameters().iter().map(meaning).collect(),
        }
    }
}
