//! A user-defined term, as sent by the form of the page.

use hitch_effects::TermEffect;
use hitch_effects::expression::operation::FUNCTIONS;
use hitch_effects::expression::{ParameterDefinition, Part, Term, TermDefinition, TermError};
use hitch_plant::Place;
use hitch_plant::hooks::signals::SIGNALS;
use serde::Deserialize;
use serde_json::{Value, json};

/// Content of the form.
#[derive(Debug, Clone, Deserialize)]
pub struct TermForm {
    id: String,
    place: String,
    formula: String,
    parameters: Vec<ParameterForm>,
}

/// A row of the form; an empty field is not a number.
#[derive(Debug, Clone, Deserialize)]
struct ParameterForm {
    name: String,
    unit: String,
    null: Option<f64>,
    start: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
}

impl TermForm {
    /// Checks the definition; returns its fault.
    pub fn check(self) -> Option<Value> {
        let formula = self.formula.clone();
        let checked = self.definition();
        match checked.map(Term::new) {
            Ok(Ok(_)) => None,
            Ok(Err(error)) => Some(fault(&formula, &error)),
            Err(fault) => Some(fault),
        }
    }

    /// The effect of the definition.
    ///
    /// # Errors
    /// The fault of the definition, as JSON for the page.
    pub fn define(self) -> Result<&'static TermEffect, Value> {
        let formula = self.formula.clone();
        TermEffect::define(self.definition()?).map_err(|error| fault(&formula, &error))
    }

    fn definition(self) -> Result<TermDefinition, Value> {
        let unknown = || json!({ "what": format!("unknown place {:?}", self.place) });
        let place = Place::named(&self.place).ok_or_else(unknown)?;
        let parameters = self.parameters.into_iter().enumerate();
        Ok(TermDefinition {
            id: self.id,
            title: String::new(),
            place,
            formula: self.formula,
            parameters: parameters
                .map(|(index, row)| row.definition(index))
                .collect::<Result<_, Value>>()?,
        })
    }
}

impl ParameterForm {
    fn definition(self, index: usize) -> Result<ParameterDefinition, Value> {
        let name = self.name;
        let number = |key: &str, value: Option<f64>| {
            let what = format!("{key} of parameter {} is not a number", index + 1);
            value.ok_or_else(|| json!({ "what": what, "hint": "write a number" }))
        };
        let start = number("start", self.start)?;
        let null = match index {
            0 => number("null", self.null)?,
            _ => start,
        };
        Ok(ParameterDefinition {
            name,
            unit: self.unit,
            meaning: String::new(),
            null,
            start,
            low: number("low", self.low)?,
            high: number("high", self.high)?,
        })
    }
}

/// The fault of a definition; for a formula with its column, in characters from 1.
fn fault(formula: &str, error: &TermError) -> Value {
    let column = match error.part {
        Part::Formula(byte) => {
            let before = formula.char_indices().take_while(|(at, _)| *at < byte);
            Some(before.count() + 1)
        }
        _ => None,
    };
    json!({ "what": error.what, "hint": error.hint, "column": column })
}

/// The elements of formulas: places, signals and functions.
pub fn offered() -> Value {
    let places = Place::all().map(
        |place| json!({ "name": place.id(), "unit": place.unit(), "meaning": place.meaning() }),
    );
    let signals = SIGNALS.iter().map(
        |signal| json!({ "name": signal.name, "unit": signal.unit, "meaning": signal.meaning }),
    );
    let functions = FUNCTIONS.iter().map(|(_, _, meaning)| *meaning);
    json!({
        "places": places.collect::<Vec<_>>(),
        "signals": signals.collect::<Vec<_>>(),
        "functions": functions.collect::<Vec<_>>(),
    })
}
