//! A user-defined term, as sent by the form of the page.

use hitch_effects::TermEffect;
use hitch_effects::expression::operation::FUNCTIONS;
use hitch_effects::expression::{ParameterDefinition, Part, Term, TermDefinition, TermError};
use hitch_plant::Place;
use hitch_plant::hooks::signals::SIGNALS;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fault::Fault;

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
    pub fn check(self) -> Option<Fault> {
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
    /// The fault of the definition, for the page.
    pub fn define(self) -> Result<&'static TermEffect, Fault> {
        let formula = self.formula.clone();
        TermEffect::define(self.definition()?).map_err(|error| fault(&formula, &error))
    }

    fn definition(self) -> Result<TermDefinition, Fault> {
        let unknown = || format!("unknown place {:?}", self.place);
        let place = Place::named(&self.place).ok_or_else(unknown)?;
        let parameters = self.parameters.into_iter().enumerate();
        Ok(TermDefinition {
            id: self.id,
            title: String::new(),
            place,
            formula: self.formula,
            parameters: parameters
                .map(|(index, row)| row.definition(index))
                .collect::<Result<_, Fault>>()?,
        })
    }
}

impl ParameterForm {
    fn definition(self, index: usize) -> Result<ParameterDefinition, Fault> {
        let name = self.name;
        let number = |key: &str, value: Option<f64>| {
            let what = format!("{key} of parameter {} is not a number", index + 1);
            value.ok_or_else(|| Fault {
                what,
                hint: Some("write a number".to_owned()),
                ..Fault::default()
            })
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
fn fault(formula: &str, error: &TermError) -> Fault {
    let column = match error.part {
        Part::Formula(byte) => {
            let before = formula.char_indices().take_while(|(at, _)| *at < byte);
            Some(before.count() + 1)
        }
        _ => None,
    };
    Fault {
        column,
        what: error.what.clone(),
        hint: Some(error.hint.clone()),
        ..Fault::default()
    }
}

/// The elements of formulas.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FormulaElements {
    /// Where a term acts.
    places: Vec<FormulaElement>,
    /// What it can depend on.
    signals: Vec<FormulaElement>,
    /// Functions, each with its meaning.
    functions: Vec<&'static str>,
}

/// A place or a signal.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FormulaElement {
    /// Its name in formulas.
    name: &'static str,
    /// Its unit.
    unit: &'static str,
    /// Its meaning.
    meaning: &'static str,
}

impl FormulaElements {
    /// All of them.
    pub fn all() -> Self {
        let place = |place: Place| FormulaElement {
            name: place.id(),
            unit: place.unit(),
            meaning: place.meaning(),
        };
        let signals = SIGNALS.iter().map(|signal| FormulaElement {
            name: signal.name,
            unit: signal.unit,
            meaning: signal.meaning,
        });
        Self {
            places: Place::all().map(place).collect(),
            signals: signals.collect(),
            functions: FUNCTIONS.iter().map(|(_, _, meaning)| *meaning).collect(),
        }
    }
}
