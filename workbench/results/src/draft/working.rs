//! The document of a draft campaign, as far as a calibration needs it.

use std::path::Path;

use hitch_closed_loop::calibrate::working::WorkingDraft;
use hitch_input::input_error::{InputError, Position};
use hitch_input::source_file::SourceFile;
use serde::Deserialize;

#[derive(Debug, Deserialize)]
struct Document {
    draft_per_cm: Value,
    mean_draft: Value,
    mean_speed_km_h: f64,
}

#[derive(Debug, Deserialize)]
struct Value {
    value: f64,
}

/// Reads the document that `hitch draft --json` wrote.
///
/// # Errors
/// The file is none, with line and column; or the draft is not above zero.
pub fn read_working(path: &Path) -> Result<WorkingDraft, InputError> {
    let hint = "give the file that hitch draft FOLDER --json FILE wrote";
    let source = SourceFile::read(path)?;
    let document: Document = serde_json::from_str(&source.text).map_err(|error| {
        let place = Position {
            line: error.line().max(1),
            column: error.column().max(1),
        };
        InputError::at(
            path,
            place,
            format!("is no result of a draft campaign: {error}"),
            hint,
        )
    })?;
    let work = WorkingDraft {
        per_cm_n: document.draft_per_cm.value,
        mean_n: document.mean_draft.value,
        speed_m_s: document.mean_speed_km_h / 3.6,
    };
    let values = [work.per_cm_n, work.mean_n, work.speed_m_s];
    if values.iter().all(|value| *value > 0.0) {
        Ok(work)
    } else {
        Err(InputError::of_file(
            path,
            "has a draft or a speed that is not above zero",
            hint,
        ))
    }
}
