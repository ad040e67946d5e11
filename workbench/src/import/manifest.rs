//! Writes `campaign.toml` of an import.

use std::fmt::Write as _;
use std::path::Path;

use hitch_campaign::Campaign;
use hitch_model_file::quoted;
use hitch_plant::Linkage;

use super::columns::Mapping;
use super::conditions::Conditions;
use super::cuts::cuts;
use crate::error::Error;

/// A log of a campaign.
#[derive(Debug, Clone)]
pub struct Log {
    /// Path, as in the manifest.
    pub file: String,
    /// Column assignment; `None` if the default applies.
    pub mapping: Option<Mapping>,
    /// Test stand.
    pub conditions: Conditions,
    /// Times of its runs, s; empty for a single run.
    pub cuts: Vec<(f64, f64)>,
}

/// The manifest of a campaign in `folder`, and the campaign itself; long logs are split into runs.
///
/// # Errors
/// If a log does not contain what its mapping states.
pub fn campaign(
    folder: &Path,
    name: &str,
    can: Option<&str>,
    mut logs: Vec<Log>,
    linkage: &Linkage,
) -> Result<(String, Campaign), Error> {
    let whole = Campaign::of_manifest(folder, &text(name, can, &logs), linkage)?;
    for (log, run) in logs.iter_mut().zip(&whole.runs) {
        log.cuts = cuts(run);
    }
    let text = text(name, can, &logs);
    let campaign = Campaign::of_manifest(folder, &text, linkage)?;
    Ok((text, campaign))
}

/// The text of the manifest.
fn text(name: &str, can: Option<&str>, logs: &[Log]) -> String {
    let mut text = format!("format = 1\nname = {}\n", quoted(name));
    if let Some(can) = can {
        text += can;
    }
    let mut mappings = logs.iter().filter_map(|log| log.mapping.as_ref());
    let common = mappings.next();
    if let Some(common) = common {
        text += "\n[columns]\n";
        text += &lines(common);
    }
    for log in logs {
        let whole = [(0.0, f64::INFINITY)];
        let cuts = if log.cuts.is_empty() {
            &whole[..]
        } else {
            &log.cuts[..]
        };
        for (from_s, to_s) in cuts {
            // Writing to a string can't fail.
            let _ = write!(
                text,
                "\n[[run]]\nfile = {}\n{}",
                quoted(&log.file),
                log.conditions.lines()
            );
            if to_s.is_finite() {
                let _ = write!(text, "from_s = {from_s}\nto_s = {to_s}\n");
            }
            if let Some(own) = log.mapping.as_ref().filter(|own| !is_same(own, common)) {
                text += "[run.columns]\n";
                text += &lines(own);
            }
        }
    }
    text
}

fn is_same(own: &Mapping, common: Option<&Mapping>) -> bool {
    common.is_some_and(|common| lines(common) == lines(own))
}

/// Column assignment, one line for each column.
#[must_use]
pub fn lines(mapping: &Mapping) -> String {
    let line = |taken: &super::Taken| format!("{} = {}\n", taken.channel, quoted(&taken.source));
    mapping.taken.iter().map(line).collect()
}

/// The path of a log in a manifest in `folder`: relative if the log is inside the folder, else absolute.
#[must_use]
pub fn path_from(folder: &Path, log: &Path) -> String {
    let full = log.canonicalize().unwrap_or_else(|_| log.to_path_buf());
    let folder = folder
        .canonicalize()
        .unwrap_or_else(|_| folder.to_path_buf());
    let path = full.strip_prefix(&folder).unwrap_or(&full);
    path.to_string_lossy().into_owned()
}
