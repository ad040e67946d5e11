//! A line of JSON: the result of one campaign, or the reason why there is none.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::path::Path;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Serialize;
use serde_json::{Map, Value, json};

use hitch_output::Document;
use hitch_output::error::Error;

/// A line of `--jsonl`.
#[derive(JsonSchema)]
#[schemars(untagged)]
pub enum Line<T> {
    /// The document of a campaign.
    Result(Success<T>),
    /// A campaign that failed; in a result, `error` is a number or absent.
    Failure(Document<Failure>),
}

/// The document that `--json` writes, with the folder in place of the name of the campaign.
pub struct Success<T>(PhantomData<T>);

/// What a line adds to the document.
#[derive(JsonSchema)]
#[expect(dead_code, reason = "only its schema is used")]
struct Named {
    /// Folder of the campaign, as it was given.
    campaign: String,
}

impl<T: JsonSchema> JsonSchema for Success<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("LineOf{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        // The document may have a key `campaign`, so the keys cannot be merged.
        json_schema!({
            "allOf": [
                generator.subschema_for::<Document<T>>(),
                generator.subschema_for::<Named>(),
            ]
        })
    }
}

/// A campaign that failed.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Failure {
    /// Folder of the campaign, as it was given.
    campaign: String,
    /// What is wrong, where, and how to correct it.
    error: String,
}

/// The name of a campaign in its line: its folder, without a slash at the end.
pub fn name(folder: &Path) -> String {
    folder.components().as_path().to_string_lossy().into_owned()
}

/// The line of a campaign with its line feed, and whether the campaign failed.
pub fn of<T: Serialize>(campaign: &str, result: Result<T, Error>) -> (String, bool) {
    let document = result.and_then(|result| {
        serde_json::to_value(Document::of(result)).map_err(|error| {
            Error::Failed(format!("the result cannot be written as JSON: {error}"))
        })
    });
    match document {
        Ok(document) => (format!("{}\n", named(campaign, document)), false),
        Err(error) => {
            let failure = Failure {
                campaign: campaign.to_owned(),
                error: error.to_string(),
            };
            (format!("{}\n", json!(Document::of(failure))), true)
        }
    }
}

/// A document with the folder of its campaign behind the version.
fn named(campaign: &str, document: Value) -> Value {
    let Value::Object(mut document) = document else {
        return document;
    };
    let mut line = Map::new();
    line.extend(document.shift_remove_entry("format"));
    line.insert("campaign".to_owned(), campaign.into());
    document.shift_remove("campaign");
    line.extend(document);
    line.into()
}

/// The campaign of a line, and whether it failed; `None` if it is not a line of a fleet.
pub fn read(line: &str) -> Option<(String, bool)> {
    let value: Value = serde_json::from_str(line).ok()?;
    let campaign = value.get("campaign")?.as_str()?.to_owned();
    Some((campaign, value.get("error").is_some_and(Value::is_string)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Result {
        error: f64,
        campaign: &'static str,
    }

    #[test]
    fn a_line_begins_with_version_and_folder() {
        let result = Result {
            error: 1.5,
            campaign: "A name",
        };
        let (line, failed) = of("lab/a", Ok(result));
        assert_eq!(
            line,
            "{\"format\":1,\"campaign\":\"lab/a\",\"error\":1.5}\n"
        );
        assert!(!failed);
        assert_eq!(read(&line), Some(("lab/a".to_owned(), false)));
        let (line, failed) = of::<Result>("lab/b", Err(Error::Failed("broken\nfile".to_owned())));
        assert_eq!(
            line,
            "{\"format\":1,\"campaign\":\"lab/b\",\"error\":\"broken\\nfile\"}\n"
        );
        assert!(failed);
        assert_eq!(read(&line), Some(("lab/b".to_owned(), true)));
        assert_eq!(read("{\"campaign\":"), None);
    }

    #[test]
    fn a_slash_at_the_end_is_the_same_folder() {
        assert_eq!(name(Path::new("lab/a/")), name(Path::new("lab/a")));
        assert_eq!(name(Path::new(".")), ".");
    }
}
