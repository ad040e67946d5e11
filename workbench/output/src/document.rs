//! JSON documents: each begins with the version of its format.

use schemars::JsonSchema;
use serde::Serialize;

use crate::error::Error;

/// Version of the documents. A new key does not change it; a removed or changed one does.
const FORMAT: u32 = 1;

/// A result as it is written.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Document<T> {
    /// Version of this format. Keys may be added without a new version.
    #[schemars(extend("const" = 1))]
    format: u32,
    #[serde(flatten)]
    result: T,
}

impl<T: Serialize> Document<T> {
    /// The document of a result.
    pub fn of(result: T) -> Self {
        Self {
            format: FORMAT,
            result,
        }
    }

    /// The document on several lines, with a line feed at its end.
    ///
    /// # Errors
    /// If the result has no JSON form.
    pub fn pretty(&self) -> Result<String, Error> {
        let text = serde_json::to_string_pretty(self).map_err(|error| {
            Error::Failed(format!("the result cannot be written as JSON: {error}"))
        })?;
        Ok(text + "\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Serialize)]
    struct Figures {
        last: f64,
        first: f64,
    }

    #[test]
    fn the_version_is_the_first_key_and_the_order_is_kept() {
        let figures = Figures {
            last: 1.0,
            first: f64::NAN,
        };
        let text = Document::of(figures).pretty().unwrap();
        assert_eq!(
            text,
            "{\n  \"format\": 1,\n  \"last\": 1.0,\n  \"first\": null\n}\n"
        );
    }
}
