//! `hitch schema`: the JSON Schema of the documents that commands write.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};

use crate::commands::fleet::Line;
use crate::commands::tune_result::Tuned;
use crate::commands::{changes, effects, loop_};
use hitch_output::Document;
use hitch_output::error::Error;
use hitch_results::base_model::fit::ShownBaseFit;
use hitch_results::comparison::Comparison;
use hitch_results::draft::DraftResult;
use hitch_results::explanation::{Diagnosis, Explanation};
use hitch_results::fleet_summary::FleetSummary;

/// Makes the schema of a document.
type MakeSchema = fn() -> Schema;

/// Commands with the option `--json`, and the schema of their document.
const DOCUMENTS: [(&str, MakeSchema); 11] = [
    ("compare", schema::<Comparison>),
    ("diagnose", schema::<Diagnosis>),
    ("explain", schema::<Explanation>),
    ("adopt", schema::<Explanation>),
    ("changes", schema::<changes::Changes>),
    ("draft", schema::<DraftResult>),
    ("summary", schema::<FleetSummary>),
    ("model fit", schema::<ShownBaseFit>),
    ("loop", schema::<loop_::Driven<'static>>),
    ("tune", schema::<Tuned>),
    ("effects", schema::<effects::Catalogue>),
];

/// Commands with the option `--jsonl`, and the schema of a line.
const LINES: [(&str, MakeSchema); 3] = [
    ("compare", line::<Comparison>),
    ("explain", line::<Explanation>),
    ("changes", line::<changes::Changes>),
];

/// Arguments of `hitch schema`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch schema\n  hitch schema explain\n  hitch schema model fit"
)]
pub struct Args {
    /// Command that writes the document; without one, the commands that have a schema are listed
    #[arg(value_name = "COMMAND")]
    command: Vec<String>,
    /// Print the schema of a line of --jsonl instead
    #[arg(long)]
    jsonl: bool,
}

/// Runs the command.
///
/// # Errors
/// If the named command writes no JSON document.
pub fn run(args: &Args) -> Result<(), Error> {
    let (documents, option) = if !args.jsonl {
        (&DOCUMENTS[..], "--json")
    } else {
        (&LINES[..], "--jsonl")
    };
    let names: Vec<&str> = documents.iter().map(|(name, _)| *name).collect();
    if args.command.is_empty() {
        return hitch_output::print(&format!("{}\n", names.join("\n")));
    }
    let wanted = args.command.join(" ");
    let Some((_, schema)) = documents.iter().find(|(name, _)| *name == wanted) else {
        return Err(Error::Usage(format!(
            "{wanted:?} is no command with {option}; these are: {}",
            names.join(", ")
        )));
    };
    let mut schema = schema();
    schema.insert(
        "title".to_owned(),
        format!("hitch {wanted} {option}").into(),
    );
    let text = serde_json::to_string_pretty(&schema)
        .map_err(|error| Error::Failed(format!("the schema cannot be written: {error}")))?;
    hitch_output::print(&format!("{text}\n"))
}

/// The schema of a result's document, as it is written.
fn schema<T: JsonSchema>() -> Schema {
    written::<Document<T>>()
}

/// The schema of a line with a result, or with the reason why there is none.
fn line<T: JsonSchema>() -> Schema {
    written::<Line<T>>()
}

fn written<T: JsonSchema>() -> Schema {
    SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator()
        .into_root_schema_for::<T>()
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    /// The names of all commands with an option.
    fn with_option(command: &clap::Command, above: &str, option: &str) -> Vec<String> {
        let of = |inner: &clap::Command| {
            let name = format!("{above} {}", inner.get_name());
            let mut names = with_option(inner, &name, option);
            if inner
                .get_arguments()
                .any(|arg| arg.get_long() == Some(option))
            {
                names.push(name.trim_start().to_owned());
            }
            names
        };
        command.get_subcommands().flat_map(of).collect()
    }

    #[test]
    fn every_command_with_a_document_has_a_schema() {
        #[derive(clap::Parser)]
        struct All {
            #[command(subcommand)]
            _command: crate::cli::Command,
        }
        for (documents, option) in [(&DOCUMENTS[..], "json"), (&LINES[..], "jsonl")] {
            let mut names = with_option(&All::command(), "", option);
            // It has the option, but writes no such document.
            names.retain(|name| name != "schema");
            let known = documents.iter().map(|(name, _)| (*name).to_owned());
            let mut known: Vec<String> = known.collect();
            names.sort();
            known.sort();
            assert_eq!(names, known);
        }
    }

    #[test]
    fn every_value_is_described() {
        for (name, schema) in DOCUMENTS.into_iter().chain(LINES) {
            let schema = serde_json::to_value(schema()).unwrap();
            let mut missing = Vec::new();
            undescribed(&schema, name, &mut missing);
            assert!(missing.is_empty(), "{missing:?}");
        }
    }

    /// Adds the paths of properties without a description.
    fn undescribed(schema: &serde_json::Value, path: &str, missing: &mut Vec<String>) {
        let of = |key: &str| schema.get(key).and_then(serde_json::Value::as_object);
        for (name, property) in of("properties").into_iter().flatten() {
            let path = format!("{path}.{name}");
            if property.get("description").is_none() {
                missing.push(path.clone());
            }
            undescribed(property, &path, missing);
        }
        for (name, definition) in of("$defs").into_iter().flatten() {
            undescribed(definition, &format!("{path}.{name}"), missing);
        }
    }
}
