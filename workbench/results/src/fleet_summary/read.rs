//! Lines of `--jsonl`, read for a summary.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::{Failed, Found, Line, Machine};
use hitch_output::error::Error;

/// A line as it is written: of `hitch explain`, or of `hitch changes`, whose explanation is in `new`.
#[derive(Deserialize)]
struct Written {
    campaign: String,
    error: Option<String>,
    new: Option<Explained>,
    #[serde(flatten)]
    explained: Option<Explained>,
}

#[derive(Deserialize)]
struct Explained {
    verdict: String,
    error_before: Option<f64>,
    error_after: Option<f64>,
    steps: Vec<Step>,
}

#[derive(Deserialize)]
struct Step {
    effect: String,
    form: Option<String>,
    confidence: Option<f64>,
    parameters: Vec<Parameter>,
}

#[derive(Deserialize)]
struct Parameter {
    unit: String,
    value: Option<f64>,
    low: Option<f64>,
    high: Option<f64>,
}

/// The lines of a file.
///
/// # Errors
/// If it cannot be read, or a line is not one of `hitch explain` or `hitch changes`.
pub fn read(path: &Path) -> Result<Vec<Line>, Error> {
    let text = fs::read_to_string(path)
        .map_err(|error| Error::Usage(format!("{}: cannot be read: {error}", path.display())))?;
    let numbered = text.lines().enumerate();
    numbered
        .filter(|(_, line)| !line.trim().is_empty())
        .map(|(index, line)| {
            parsed(line).map_err(|why| {
                let place = format!("{}:{}", path.display(), index + 1);
                Error::Usage(format!(
                    "{place}: is not a line that hitch explain or hitch changes writes with --jsonl: {why}"
                ))
            })
        })
        .collect()
}

fn parsed(line: &str) -> Result<Line, String> {
    let written: Written = serde_json::from_str(line).map_err(|error| error.to_string())?;
    let campaign = written.campaign;
    if let Some(error) = written.error {
        return Ok(Line::Failed(Failed { campaign, error }));
    }
    let explained = written.new.or(written.explained);
    let explained = explained.ok_or("it has no verdict with steps")?;
    let (mut effects, mut units) = (BTreeMap::new(), BTreeMap::new());
    for step in explained.steps {
        let form = step.form.map(|form| format!("/{form}"));
        let name = step.effect + form.as_deref().unwrap_or_default();
        let Some(first) = step.parameters.into_iter().next() else {
            continue;
        };
        let found = Found {
            size: first.value.unwrap_or(f64::NAN),
            low: first.low,
            high: first.high,
            confidence: step.confidence.unwrap_or_default(),
            differs: false,
        };
        units.insert(name.clone(), first.unit);
        effects.insert(name, found);
    }
    let machine = Machine {
        campaign,
        verdict: explained.verdict,
        error_before: explained.error_before.unwrap_or(f64::NAN),
        error_after: explained.error_after.unwrap_or(f64::NAN),
        effects,
    };
    Ok(Line::Result { machine, units })
}
