//! Writes `campaign.toml` of an import.

use std::path::Path;

use hitch_campaign::{Bench, Campaign};
use hitch_model_file::quoted;
use hitch_plant::Linkage;

use super::cuts::cuts;
use super::mapping::Mapping;
use crate::import::run_block::RunBlock;
use hitch_output::error::Error;

/// A log of a campaign.
#[derive(Debug, Clone)]
pub struct Log {
    /// Path, as in the manifest.
    pub file: String,
    /// Paths of the files in which the recording continues.
    pub then: Vec<String>,
    /// Column assignment; `None` if the default applies.
    pub mapping: Option<Mapping>,
    /// Test stand.
    pub bench: Bench,
    /// Times of its runs, s; empty for a single run of all its samples.
    pub cuts: Vec<(f64, f64)>,
}

/// The manifest of a campaign in `folder`, the campaign itself, and why logs were split into runs, one line each.
///
/// # Errors
/// If a log does not contain what its mapping states, or no run of a log begins at rest.
pub fn campaign(
    folder: &Path,
    name: &str,
    can: Option<&str>,
    logs: Vec<Log>,
    linkage: &Linkage,
) -> Result<(String, Campaign, Vec<String>), Error> {
    let mut notes = Vec::new();
    let logs = joined(folder, logs, can, linkage, &mut notes)?;
    let (whole, logged) = Campaign::uncut(folder, &text(name, can, &logs), linkage)?;
    let mut useful = Vec::with_capacity(logs.len());
    for ((mut log, run), logged) in logs.into_iter().zip(&whole.runs).zip(&logged) {
        let found = cuts(run, &logged.steps);
        let said = |note: &String| format!("{}: {note}", run.file);
        let whole = logged.cut_off.iter().chain(&logged.rates);
        notes.extend(whole.chain(&found.notes).map(said));
        log.cuts = found.runs;
        useful.extend((!found.is_useless).then_some(log));
    }
    if useful.is_empty() {
        let hint = "import the file before it as well, or log the run again from a rest on";
        return Err(Error::Usage(format!("{}; {hint}", notes.join("; "))));
    }
    let logs = useful;
    let text = text(name, can, &logs);
    let campaign = Campaign::of_manifest(folder, &text, linkage)?;
    Ok((text, campaign, notes))
}

/// The logs, with those that continue the one before them joined to it.
fn joined(
    folder: &Path,
    logs: Vec<Log>,
    can: Option<&str>,
    linkage: &Linkage,
    notes: &mut Vec<String>,
) -> Result<Vec<Log>, Error> {
    if logs.len() < 2 {
        return Ok(logs);
    }
    let continued = Campaign::continued(folder, &text("", can, &logs), linkage)?;
    let mut joined: Vec<Log> = Vec::new();
    for (log, is_continued) in logs.into_iter().zip(continued) {
        match joined.last_mut() {
            Some(last) if is_continued && last.bench == log.bench => {
                notes.push(format!(
                    "{} continues {}: they are joined",
                    log.file, last.file
                ));
                last.then.push(log.file);
            }
            _ => joined.push(log),
        }
    }
    Ok(joined)
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
        let parts = log.cuts.iter().copied().map(Some);
        let whole = log.cuts.is_empty().then_some(None);
        for span_s in whole.into_iter().chain(parts) {
            let block = RunBlock {
                file: &log.file,
                then: &log.then,
                bench: log.bench,
                oil_temperature_c: None,
                span_s,
            };
            text += &block.to_string();
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A log of two lifts, between which the clock jumps by `jump_s`.
    fn two_lifts(jump_s: f64) -> String {
        let row = |index: u32| {
            let time_s = 0.02 * f64::from(index);
            let logged_s = time_s + if index < 500 { 0.0 } else { jump_s };
            let lift_s = time_s % 10.0;
            let current_a = if (4.0..6.0).contains(&lift_s) {
                1.5
            } else {
                0.0
            };
            let angle_deg = 50.0 + 20.0 * (lift_s.clamp(4.0, 6.0) - 4.0);
            format!("{logged_s},{current_a},0,{angle_deg}\n")
        };
        let rows: String = (0..1000).map(row).collect();
        format!("time_s,lift_current_a,lower_current_a,rocker_angle_deg\n{rows}")
    }

    #[test]
    fn a_log_is_split_where_its_clock_was_set() {
        let folder = tempfile::tempdir().unwrap();
        let imported = |jump_s: f64| {
            std::fs::write(folder.path().join("a.csv"), two_lifts(jump_s)).unwrap();
            let log = Log {
                file: "a.csv".to_owned(),
                then: Vec::new(),
                mapping: None,
                bench: Bench::Hitch { load_kg: 50.0 },
                cuts: Vec::new(),
            };
            let nominal = hitch_model_file::nominal();
            campaign(folder.path(), "a", None, vec![log], nominal.linkage())
        };
        for (jump_s, expected) in [
            (3.0, "its clock jumps from 9.98 s"),
            (3_600.0, "its clock jumps from 9.98 s"),
            (-5.0, "its clock goes back from 9.98 s to 5.00 s"),
        ] {
            let (_, campaign, notes) = imported(jump_s).unwrap_or_else(|error| panic!("{error}"));
            let lasts_s: Vec<f64> = campaign
                .runs
                .iter()
                .map(hitch_campaign::Run::duration_s)
                .collect();
            assert_eq!(lasts_s.len(), 2, "{notes:?}");
            assert!(
                lasts_s.iter().all(|lasts_s| (lasts_s - 9.98).abs() < 1e-6),
                "{lasts_s:?}"
            );
            assert!(notes[0].contains(expected), "{notes:?}");
        }
    }
}
