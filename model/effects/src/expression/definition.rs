//! The user's definition of a term, and the faults that can be found before its formula is parsed.

use hitch_input::Unit;
use hitch_input::fault::{Fault, shown};
use hitch_plant::Place;
use hitch_plant::hooks::signals::SIGNALS;

use crate::expression::operation::Function;
use crate::expression::token::is_whole_name;

/// Most parameters of a term: measurements rarely determine more than two.
const MOST_PARAMETERS: usize = 8;

/// A user's definition of a parameter. Values are in its unit.
#[derive(Debug, Clone, PartialEq)]
pub struct ParameterDefinition {
    /// Name in the formula.
    pub name: String,
    /// Unit; empty for a pure number.
    pub unit: String,
    /// Description; may be empty.
    pub meaning: String,
    /// Value at which the term is off; only used for the first parameter.
    pub null: f64,
    /// Start value of a fit: an expected size.
    pub start: f64,
    /// Smallest allowed value.
    pub low: f64,
    /// Largest allowed value.
    pub high: f64,
}

/// A user's definition of a term.
#[derive(Debug, Clone, PartialEq)]
pub struct TermDefinition {
    /// Id in files, commands and reports.
    pub id: String,
    /// Title; may be empty.
    pub title: String,
    /// The place where it acts.
    pub place: Place,
    /// The formula.
    pub formula: String,
    /// Its parameters; the first one is its size.
    pub parameters: Vec<ParameterDefinition>,
}

/// The faulty part of a definition.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The name of the term.
    Id,
    /// The parameters as a whole.
    Parameters,
    /// A parameter, by its index, and its key in a model file.
    Parameter(usize, &'static str),
    /// The formula, at a byte.
    Formula(usize),
}

/// A fault in the definition of a term: where, what, and a correction.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TermError {
    /// The faulty part.
    pub part: Part,
    /// Description.
    pub what: String,
    /// Suggested correction.
    pub hint: String,
}

impl std::fmt::Display for TermError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}; {}", self.what, self.hint)
    }
}

impl std::error::Error for TermError {}

impl From<Fault> for TermError {
    fn from(fault: Fault) -> Self {
        Self::new(Part::Formula(fault.byte), fault.what, fault.hint)
    }
}

impl TermError {
    /// A fault of a part.
    pub fn new(part: Part, what: impl Into<String>, hint: impl Into<String>) -> Self {
        let (what, hint) = (what.into(), hint.into());
        Self { part, what, hint }
    }
}

impl ParameterDefinition {
    /// Its key in a model file: the name including the unit, `force_n`, `gain_lpm_per_bar`.
    #[must_use]
    pub fn key(&self) -> String {
        let unit = self
            .unit
            .replace("l/min", "lpm")
            .replace("/bar", "_per_bar")
            .replace("degC", "c");
        let words = unit
            .split(|c: char| !c.is_ascii_alphanumeric())
            .filter(|word| !word.is_empty());
        words.fold(self.name.clone(), |key, word| {
            key + "_" + &word.to_ascii_lowercase()
        })
    }
}

pub(crate) fn check_id(id: &str) -> Result<(), TermError> {
    let good = id.split('-').all(|word| {
        !word.is_empty()
            && word
                .chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
    });
    if good && id.len() <= 60 {
        return Ok(());
    }
    let what = format!("{} is not a valid name of a term", shown(id));
    Err(TermError::new(
        Part::Id,
        what,
        "use lower-case letters and digits, with words joined by -, such as end-cushion",
    ))
}

pub(crate) fn check_parameters(parameters: &[ParameterDefinition]) -> Result<Vec<Unit>, TermError> {
    let count = parameters.len();
    if count == 0 {
        let hint = "add a [[term.parameter]]: the first one is the size of the term, which a fit estimates";
        return Err(TermError::new(
            Part::Parameters,
            "the term has no parameter",
            hint,
        ));
    }
    if count > MOST_PARAMETERS {
        let what = format!("the term has {count} parameters");
        let hint = format!("the maximum is {MOST_PARAMETERS}; write known values as numbers");
        return Err(TermError::new(Part::Parameters, what, hint));
    }
    let check = |(index, parameter): (usize, &ParameterDefinition)| {
        check_name(index, parameters)?;
        check_range(index, parameter)?;
        let fault =
            |fault: Fault| TermError::new(Part::Parameter(index, "unit"), fault.what, fault.hint);
        Unit::parse(&parameter.unit).map_err(fault)
    };
    parameters.iter().enumerate().map(check).collect()
}

fn check_name(index: usize, parameters: &[ParameterDefinition]) -> Result<(), TermError> {
    let parameter = &parameters[index];
    let name = parameter.name.as_str();
    let earlier = &parameters[..index];
    let fault = |what: &str, hint: &str| {
        Err(TermError::new(
            Part::Parameter(index, "name"),
            format!("{} {what}", shown(name)),
            hint,
        ))
    };
    if !is_whole_name(name) || name.len() > 40 {
        return fault(
            "is not a valid name of a parameter",
            "write letters, digits and _, beginning with a letter",
        );
    }
    if SIGNALS.iter().any(|signal| signal.name == name) || Function::named(name).is_some() {
        return fault(
            "is a signal or a function already",
            "give the parameter another name",
        );
    }
    let key = parameter.key();
    if key == "id"
        || earlier
            .iter()
            .any(|other| other.name == name || other.key() == key)
    {
        return fault("is there already", "give the parameter another name");
    }
    Ok(())
}

fn check_range(index: usize, parameter: &ParameterDefinition) -> Result<(), TermError> {
    let ParameterDefinition {
        name,
        null,
        start,
        low,
        high,
        ..
    } = parameter;
    let fault = |key, what: String, hint: &str| {
        Err(TermError::new(Part::Parameter(index, key), what, hint))
    };
    if !(low.is_finite() && high.is_finite() && low < high) {
        return fault(
            "low",
            format!("the range of {name}, {low} to {high}, is empty"),
            "low has to be below high",
        );
    }
    let range = *low..=*high;
    if !range.contains(start) {
        return fault(
            "start",
            format!("start = {start} of {name} is outside of {low} to {high}"),
            "widen the range",
        );
    }
    if index == 0 && !range.contains(null) {
        return fault(
            "null",
            format!("null = {null} of {name} is outside of {low} to {high}"),
            "widen the range",
        );
    }
    if index == 0 && start == null {
        let hint = "use the expected size as start value";
        return fault(
            "start",
            format!("{name} starts at its null value, so the term is off"),
            hint,
        );
    }
    Ok(())
}
