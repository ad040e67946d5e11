//! A fault that the page shows.

use schemars::JsonSchema;
use serde::Serialize;

use hitch_output::error::Error;

/// What is wrong, where, and how to correct it.
#[derive(Debug, Default, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Fault {
    /// The file that is its cause.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Line in the file, from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub line: Option<usize>,
    /// Column in the line, or in a formula, in characters from 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub column: Option<usize>,
    /// What is wrong.
    pub what: String,
    /// A suggested correction.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hint: Option<String>,
}

impl From<String> for Fault {
    fn from(what: String) -> Self {
        Self {
            what,
            ..Self::default()
        }
    }
}

impl From<&Error> for Fault {
    fn from(error: &Error) -> Self {
        match error {
            Error::Input(input) => Self {
                file: Some(input.file.display().to_string()),
                line: input.place.map(|place| place.line),
                column: input.place.map(|place| place.column),
                what: input.what.clone(),
                hint: Some(input.hint.clone()),
            },
            other => other.to_string().into(),
        }
    }
}
