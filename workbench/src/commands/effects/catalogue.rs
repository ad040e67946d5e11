//! The catalogue of effects as a document for scripts.

use hitch_plant::{Effect, Parameter};
use schemars::JsonSchema;
use serde::Serialize;

/// Effects that a model can have.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Catalogue {
    /// The effects of the catalogue, and the terms of the model file; only the named ones.
    effects: Vec<Entry>,
}

/// An effect.
#[derive(Debug, Serialize, JsonSchema)]
struct Entry {
    /// Its id, as in a model file.
    id: &'static str,
    /// Its form, if several effects have the id.
    form: Option<&'static str>,
    /// Short description.
    title: &'static str,
    /// Its equation.
    equation: &'static str,
    /// Where the equation and the ranges are from.
    source: &'static str,
    /// Where a measurement shows it, and which effects look the same.
    shows: &'static str,
    /// The channels that show it.
    channels: Vec<&'static str>,
    /// Its parameters. The first is its size.
    parameters: Vec<Described>,
}

/// A parameter of an effect.
#[derive(Debug, Serialize, JsonSchema)]
struct Described {
    /// Its key in a model file.
    key: &'static str,
    /// Its name, without the unit.
    name: &'static str,
    /// Unit of its values; empty for a pure number.
    unit: &'static str,
    /// Short description.
    meaning: &'static str,
    /// Value at which the effect is off; only the size has one.
    null: Option<f64>,
    /// Typical value.
    typical: f64,
    /// Smallest and largest allowed value.
    range: [f64; 2],
}

impl Catalogue {
    /// The document of these effects.
    pub fn of<'e>(effects: impl Iterator<Item = &'e dyn Effect>) -> Self {
        Self {
            effects: effects.map(Entry::of).collect(),
        }
    }
}

impl Entry {
    fn of(effect: &dyn Effect) -> Self {
        let channels = effect.channels().iter().map(|channel| channel.key());
        let parameters = effect.parameters().iter().enumerate();
        let described = |(index, parameter): (usize, &Parameter)| Described {
            key: parameter.key,
            name: parameter.name,
            unit: parameter.unit,
            meaning: parameter.meaning,
            null: (index == 0).then_some(parameter.null),
            typical: parameter.typical,
            range: [parameter.low, parameter.high],
        };
        Self {
            id: effect.id(),
            form: effect.form(),
            title: effect.title(),
            equation: effect.equation(),
            source: effect.source(),
            shows: effect.shows(),
            channels: channels.collect(),
            parameters: parameters.map(described).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use hitch_effects::CATALOGUE;

    use super::*;

    #[test]
    fn a_script_can_write_every_effect_in_its_range() {
        let catalogue = Catalogue::of(CATALOGUE.iter().copied());
        assert_eq!(catalogue.effects.len(), CATALOGUE.len());
        for effect in &catalogue.effects {
            let form = effect.form.map(|form| format!("form = \"{form}\"\n"));
            let mut block = format!("id = \"{}\"\n{}", effect.id, form.unwrap_or_default());
            for Described {
                key,
                typical,
                range: [low, high],
                ..
            } in &effect.parameters
            {
                assert!((*low..=*high).contains(typical), "{} {key}", effect.id);
                block += &format!("{key} = {typical}\n");
            }
            let source = hitch_input::source_file::SourceFile {
                path: "effect.toml".into(),
                text: format!("format = 1\nbase = \"nominal\"\n[[effect]]\n{block}"),
            };
            let model = hitch_model_file::parse(&source).unwrap();
            assert_eq!(model.effects[0].effect.id(), effect.id);
            assert_eq!(model.effects[0].effect.form(), effect.form);
        }
    }
}
