//! The proposed assignment of an upload as the page shows it.

use std::path::{Path, PathBuf};

use hitch_campaign::survey::{LogColumn, TIMES, check_source, run_columns, usual_units};
use schemars::JsonSchema;
use serde::Serialize;

use super::proposal::{Group, Proposal, title};
use hitch_results::import::{Files, Kind, Taken, loads_in_name};

/// What the files of an upload are.
#[derive(Debug, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Surveyed {
    /// A campaign with its logs.
    Campaign(FoundCampaign),
    /// Logs to import.
    Logs(ProposedCampaign),
}

/// A campaign with its logs.
#[derive(Debug, Serialize, JsonSchema)]
pub struct FoundCampaign {
    /// Its name.
    pub campaign: String,
    /// Number of its runs.
    pub runs: usize,
}

/// The proposed assignment of logs.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProposedCampaign {
    /// Name of the campaign.
    pub name: String,
    /// The logs.
    pub logs: Vec<ProposedLog>,
    /// Logs with equal columns.
    pub groups: Vec<ProposedGroup>,
    /// The signals of a run.
    pub signals: Vec<Signal>,
}

/// A log.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProposedLog {
    /// Its file.
    pub file: String,
    /// The load in its name, kg.
    pub load_kg: Option<f64>,
}

/// A signal of a run.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Signal {
    /// Key.
    pub key: &'static str,
    /// Name for a reader.
    pub title: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Units that convert to it.
    pub units: Vec<&'static str>,
    /// Units of a sensor, with which two points have to be known.
    pub raw: Vec<&'static str>,
}

/// Logs with equal columns.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProposedGroup {
    /// Their files.
    pub files: Vec<String>,
    /// Whether they have a column of times.
    pub times: bool,
    /// Whether their columns have units of their own.
    pub own_units: bool,
    /// Their columns.
    pub columns: Vec<ProposedColumn>,
    /// The columns that are taken.
    pub taken: Vec<TakenColumn>,
    /// What was assumed, and columns of a signal that are left out with the reason.
    pub notes: Vec<String>,
    /// The other columns that are not used.
    pub unused: Vec<String>,
    /// What could not be determined.
    pub untold: Option<String>,
}

/// A column of a log.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProposedColumn {
    /// Its name.
    pub name: String,
    /// The unit that the log states.
    pub unit: Option<String>,
}

/// A column that is taken for a signal.
#[derive(Debug, Serialize, JsonSchema)]
pub struct TakenColumn {
    /// Key of the signal.
    pub channel: &'static str,
    /// Name of the column.
    pub column: String,
    /// Its unit; `null` if the log states it.
    pub unit: Option<String>,
    /// The reason.
    pub reason: String,
    /// Whether name or unit is an assumption.
    pub assumed: bool,
}

impl Surveyed {
    /// The view of a proposal.
    pub fn of(proposal: &Proposal) -> Self {
        match proposal {
            Proposal::Campaign { name, runs } => Self::Campaign(FoundCampaign {
                campaign: name.clone(),
                runs: *runs,
            }),
            Proposal::Logs { files, groups } => Self::Logs(ProposedCampaign::of(files, groups)),
        }
    }
}

impl ProposedCampaign {
    fn of(files: &Files, groups: &[Group]) -> Self {
        let name = files.logs.first().and_then(|log| log.file_stem());
        let name = name.map_or_else(|| "campaign".into(), |name| name.to_string_lossy());
        let log = |log: &PathBuf| ProposedLog {
            file: file_name(log),
            load_kg: match loads_in_name(log)[..] {
                [load_kg] => Some(load_kg),
                _ => None,
            },
        };
        let signal = |(key, unit): (&'static str, &'static str)| {
            let units: Vec<&str> = usual_units(key).collect();
            Signal {
                key,
                title: title(key),
                unit,
                raw: raw_units(key, &units),
                units,
            }
        };
        Self {
            name: name.into_owned(),
            logs: files.logs.iter().map(log).collect(),
            groups: groups.iter().map(ProposedGroup::of).collect(),
            signals: run_columns().map(signal).collect(),
        }
    }
}

impl ProposedGroup {
    fn of(group: &Group) -> Self {
        let headings = group.headings.iter();
        let column = |column: &LogColumn| ProposedColumn {
            name: column.name.clone(),
            unit: column.unit.clone(),
        };
        Self {
            files: headings
                .map(|heading| file_name(Path::new(heading)))
                .collect(),
            times: group.kind == Kind::Table,
            own_units: group.kind == Kind::Signals,
            columns: group.columns.iter().map(column).collect(),
            taken: group.mapping.taken.iter().map(TakenColumn::of).collect(),
            notes: group.notes.clone(),
            unused: unused(group),
            untold: group.untold.as_ref().map(|untold| untold.what.clone()),
        }
    }
}

impl TakenColumn {
    fn of(taken: &Taken) -> Self {
        let parts = check_source(taken.channel, &taken.source);
        let (column, unit) = parts.unwrap_or_else(|_| (taken.source.clone(), None));
        Self {
            channel: taken.channel,
            column,
            unit,
            reason: taken.reason.clone(),
            assumed: taken.is_assumed,
        }
    }
}

/// Units of a sensor whose values become those of a signal by two known points. Times have none.
fn raw_units(name: &str, units: &[&str]) -> Vec<&'static str> {
    const RAW: [&str; 5] = ["V", "mV", "mA", "%", "counts"];
    let has_none = name == TIMES;
    RAW.into_iter()
        .filter(|unit| !has_none && !units.contains(unit))
        .collect()
}

/// Names of the columns that are neither taken nor named in a note.
fn unused(group: &Group) -> Vec<String> {
    let is_taken = |name: &str| {
        let mut sources = group.mapping.taken.iter();
        sources.any(|taken| {
            let parts = check_source(taken.channel, &taken.source);
            parts.map_or(taken.source == name, |(known, _)| known == name)
        })
    };
    let is_noted = |name: &str| {
        let said = format!("left out: \"{name}\"");
        group.notes.iter().any(|note| note.starts_with(&said))
    };
    let names = group.columns.iter().map(|column| column.name.as_str());
    names
        .filter(|name| !is_taken(name) && !is_noted(name))
        .map(str::to_owned)
        .collect()
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}
