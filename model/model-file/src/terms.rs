//! User-defined terms in a model file: `[[term]]`, with a `[[term.parameter]]` for each parameter.

use std::fmt::Write as _;

use hitch_effects::TermEffect;
use hitch_effects::expression::{ParameterDefinition, Part, TermDefinition, TermError};
use hitch_input::input_error::{InputError, quote};
use hitch_input::naming::offer_names;
use hitch_input::toml_reader::TomlTable;
use hitch_plant::{Effect, Place};

use crate::quoted::quoted;
use crate::round_trip::decimal;

/// Reads the terms of a file.
pub fn read(top: &TomlTable<'_>) -> Result<Vec<&'static dyn Effect>, InputError> {
    let mut terms: Vec<&'static dyn Effect> = Vec::new();
    for table in &top.tables("term")? {
        let definition = definition(table)?;
        if terms.iter().any(|other| other.id() == definition.id) {
            let what = format!("{} is duplicated", definition.id);
            return Err(table.error_at("id", what, "delete one of the two [[term]] blocks"));
        }
        terms.push(TermEffect::define(definition).map_err(|error| placed(table, error))?);
    }
    Ok(terms)
}

fn definition(table: &TomlTable<'_>) -> Result<TermDefinition, InputError> {
    table.only(&["id", "title", "place", "formula", "parameter"])?;
    let parameters = table.tables("parameter")?;
    let parameters = parameters
        .iter()
        .enumerate()
        .map(|(index, table)| parameter(table, index == 0));
    Ok(TermDefinition {
        id: table.required_text("id")?.to_owned(),
        title: table.text("title")?.unwrap_or_default().to_owned(),
        place: place(table)?,
        formula: table.required_text("formula")?.to_owned(),
        parameters: parameters.collect::<Result<_, _>>()?,
    })
}

fn place(table: &TomlTable<'_>) -> Result<Place, InputError> {
    let id = table.required_text("place")?;
    Place::named(id).ok_or_else(|| {
        let known: Vec<&str> = Place::all().map(Place::id).collect();
        table.error_at(
            "place",
            format!("place {} is not known", quote(id)),
            offer_names(id, &known),
        )
    })
}

/// Reads a parameter; only the size has a null value.
fn parameter(table: &TomlTable<'_>, size: bool) -> Result<ParameterDefinition, InputError> {
    let keys = ["name", "unit", "meaning", "start", "low", "high", "null"];
    table.only(&keys[..if size { keys.len() } else { keys.len() - 1 }])?;
    let number = |key| table.required_number(key, f64::MIN..=f64::MAX);
    let start = number("start")?;
    Ok(ParameterDefinition {
        name: table.required_text("name")?.to_owned(),
        unit: table.text("unit")?.unwrap_or_default().to_owned(),
        meaning: table.text("meaning")?.unwrap_or_default().to_owned(),
        null: if size { number("null")? } else { start },
        start,
        low: number("low")?,
        high: number("high")?,
    })
}

/// A fault of a definition, with its position in the file.
fn placed(table: &TomlTable<'_>, error: TermError) -> InputError {
    let TermError { part, what, hint } = error;
    match part {
        Part::Id => table.error_at("id", what, hint),
        Part::Parameters => table.error(what, hint),
        Part::Formula(byte) => table.error_inside("formula", byte, what, hint),
        Part::Parameter(index, key) => {
            match table.tables("parameter").unwrap_or_default().get(index) {
                Some(parameter) => parameter.error_at(key, what, hint),
                None => table.error(what, hint),
            }
        }
    }
}

/// Writes a term. Writing to a string cannot fail, so the results are ignored.
pub fn write(text: &mut String, term: &TermEffect) {
    let TermDefinition {
        id,
        title,
        place,
        formula,
        parameters,
    } = term.term().definition();
    let _ = write!(text, "\n[[term]]\nid = {}\n", quoted(id));
    write_unless_empty(text, "title", title);
    let _ = writeln!(
        text,
        "place = \"{}\"\nformula = {}",
        place.id(),
        quoted(formula)
    );
    for (index, parameter) in parameters.iter().enumerate() {
        write_parameter(text, parameter, index == 0);
    }
}

fn write_parameter(text: &mut String, parameter: &ParameterDefinition, size: bool) {
    let ParameterDefinition {
        name,
        unit,
        meaning,
        null,
        start,
        low,
        high,
    } = parameter;
    let _ = write!(text, "\n[[term.parameter]]\nname = {}\n", quoted(name));
    write_unless_empty(text, "unit", unit);
    write_unless_empty(text, "meaning", meaning);
    let null = size.then_some(("null", null));
    for (key, value) in null
        .into_iter()
        .chain([("start", start), ("low", low), ("high", high)])
    {
        let _ = writeln!(text, "{key} = {}", decimal(*value, 1.0));
    }
}

fn write_unless_empty(text: &mut String, key: &str, value: &str) {
    if !value.is_empty() {
        let _ = writeln!(text, "{key} = {}", quoted(value));
    }
}
