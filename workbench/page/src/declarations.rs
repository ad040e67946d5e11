//! The declarations of the views for the scripts, `web/views.d.ts`, from the schemas of their types.

use std::path::Path;

use hitch_closed_loop::driven::Described;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value};

use super::first::{CheckedConstants, Sheet};
use super::first_table::TakenTable;
use super::live::answer::LoopAnswer;
use super::own_term::FormulaElements;
use super::routes::Checked;
use super::upload::surveyed::Surveyed;
use super::views::message::Message;
use super::views::next_experiment::ExpectedRuns;
use super::views::run::RunView;
use super::views::state::Begun;
use super::views::trial::{RunParts, Signature, TriedRuns};
use hitch_results::comparison::{ChangedStretch, WorstStretch};
use hitch_results::report::error_map::ModelMap;
use hitch_results::report::map_view::Located;
use hitch_results::web::plot::{RowPlot, Samples, SimulatedChannel};

/// The generated file, in the crate.
const FILE: &str = "../results/src/web/views.d.ts";
/// Writes it, if it is set in the environment.
const WRITE: &str = "HITCH_WRITE_DECLARATIONS";
/// Longest line.
const WIDTH: usize = 124;

#[test]
fn the_declarations_are_those_of_the_views() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(FILE);
    let text = declarations();
    if std::env::var_os(WRITE).is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let known = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        known == text,
        "{FILE} is not what the views are; renew it: {WRITE}=1 cargo test -p hitch-page declarations"
    );
}

/// Every declaration.
fn declarations() -> String {
    let mut generator = SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator();
    views(&mut generator);
    let definitions = generator.take_definitions(true);
    let mut text = format!(
        "/** What the program sends to the scripts of the page and of the reports, as JSON. A number that is not finite is `null`.\n \
         * Generated from the Rust types: {WRITE}=1 cargo test -p hitch-page declarations */\n"
    );
    let mut names: Vec<&String> = definitions.keys().collect();
    names.sort();
    for name in names {
        assert!(
            !name.ends_with(char::is_numeric),
            "two types are called {name}"
        );
        text += &declaration(name, definitions[name].as_object().expect("a schema"));
    }
    text
}

/// The roots: what is sent as a whole.
fn views(generator: &mut SchemaGenerator) {
    root::<Begun>(generator);
    root::<RunView>(generator);
    root::<RunParts<SimulatedChannel<Samples>>>(generator);
    root::<RunParts<Signature>>(generator);
    root::<TriedRuns>(generator);
    root::<Located<WorstStretch>>(generator);
    root::<Located<ChangedStretch>>(generator);
    root::<Message>(generator);
    root::<ModelMap>(generator);
    root::<Surveyed>(generator);
    root::<Sheet>(generator);
    root::<TakenTable>(generator);
    root::<CheckedConstants>(generator);
    root::<ExpectedRuns>(generator);
    root::<FormulaElements>(generator);
    root::<Checked>(generator);
    root::<Described>(generator);
    root::<LoopAnswer>(generator);
    root::<RowPlot<Vec<f64>, Samples>>(generator);
}

fn root<T: JsonSchema>(generator: &mut SchemaGenerator) {
    generator.subschema_for::<T>();
}

fn declaration(name: &str, schema: &Map<String, Value>) -> String {
    let doc = doc(schema, "");
    if schema.contains_key("properties") {
        format!("\n{doc}interface {name} {{\n{}}}\n", members(schema))
    } else {
        format!("\n{doc}type {name} = {};\n", shape(schema))
    }
}

/// The members of an object, a line each.
fn members(schema: &Map<String, Value>) -> String {
    let properties = schema["properties"].as_object().expect("properties");
    let is_required = |name: &String| {
        let required = schema.get("required").and_then(Value::as_array);
        required.is_some_and(|names| names.iter().any(|one| one == name))
    };
    let member = |(name, schema): (&String, &Value)| {
        let schema = schema.as_object().expect("a schema");
        let mark = if is_required(name) { "" } else { "?" };
        // What is left out is not `null`.
        let shape = shape(schema);
        let shape = if mark.is_empty() {
            &shape
        } else {
            shape.trim_end_matches(" | null")
        };
        format!("{}  {name}{mark}: {shape};\n", doc(schema, "  "))
    };
    properties.iter().map(member).collect()
}

/// The description as a comment.
fn doc(schema: &Map<String, Value>, indent: &str) -> String {
    let Some(text) = schema.get("description").and_then(Value::as_str) else {
        return String::new();
    };
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let mut lines = vec![format!("{indent}/**")];
    for word in text.split(' ').chain(["*/"]) {
        let last = lines.last_mut().expect("a line");
        if last.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(format!("{indent} * {word}"));
        } else {
            last.push(' ');
            last.push_str(word);
        }
    }
    lines.join("\n") + "\n"
}

/// The type of a schema.
fn shape(schema: &Map<String, Value>) -> String {
    if let Some(reference) = schema.get("$ref").and_then(Value::as_str) {
        return reference.rsplit('/').next().expect("a name").to_owned();
    }
    if let Some(value) = schema.get("const") {
        return value.to_string();
    }
    if let Some(values) = schema.get("enum").and_then(Value::as_array) {
        return union(values.iter().map(Value::to_string));
    }
    for key in ["anyOf", "oneOf"] {
        if let Some(shapes) = schema.get(key).and_then(Value::as_array) {
            return union(
                shapes
                    .iter()
                    .map(|one| shape(one.as_object().expect("a schema"))),
            );
        }
    }
    match &schema["type"] {
        Value::String(kind) => of_kind(kind, schema),
        Value::Array(kinds) => union(
            kinds
                .iter()
                .map(|kind| of_kind(kind.as_str().expect("a type"), schema)),
        ),
        other => panic!("no type: {other}"),
    }
}

fn of_kind(kind: &str, schema: &Map<String, Value>) -> String {
    match kind {
        "null" | "string" | "boolean" => kind.to_owned(),
        "number" | "integer" => "number".to_owned(),
        "array" => {
            let item = shape(schema["items"].as_object().expect("items"));
            let item = if item.contains(' ') {
                format!("({item})")
            } else {
                item
            };
            let count = |key| schema.get(key).and_then(Value::as_u64);
            match (count("minItems"), count("maxItems")) {
                (Some(least), Some(most)) if least == most => {
                    format!("[{}]", vec![item; most as usize].join(", "))
                }
                _ => format!("{item}[]"),
            }
        }
        "object" => {
            let members = members(schema);
            let members = members
                .lines()
                .map(str::trim)
                .filter(|line| !line.starts_with("/**"));
            format!(
                "{{ {} }}",
                members.collect::<Vec<_>>().join(" ").trim_end_matches(';')
            )
        }
        other => panic!("{other} has no TypeScript type"),
    }
}

fn union(shapes: impl Iterator<Item = String>) -> String {
    shapes.collect::<Vec<_>>().join(" | ")
}
