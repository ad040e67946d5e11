//! The proposed assignment of an upload's files.

use std::path::{Path, PathBuf};

use hitch_campaign::survey::{LogColumn, TIMES, check_source, is_bus, run_columns, usual_units};
use hitch_campaign::{Campaign, CampaignError};
use hitch_plant::Linkage;
use serde_json::{Value, json};

use crate::error::Error;
use crate::import::files::columns;
use crate::import::{Columns, Files, Kind, Mapping, Taken, Undetermined, load_in_name};

/// Name of a campaign's manifest.
pub const MANIFEST: &str = "campaign.toml";

/// What the files are.
#[derive(Debug)]
pub enum Proposal {
    /// A campaign with its logs.
    Campaign {
        /// Its name, and the number of its runs.
        name: String,
        /// Number of runs.
        runs: usize,
    },
    /// Logs to import.
    Logs {
        /// The files.
        files: Files,
        /// Logs with equal columns and equal assignment.
        groups: Vec<Group>,
    },
}

/// Logs with equal columns and equal assignment.
#[derive(Debug)]
pub struct Group {
    /// Names of the files, for a heading.
    pub headings: Vec<String>,
    /// Indices of its logs.
    pub logs: Vec<usize>,
    /// Kind of the logs.
    pub kind: Kind,
    /// The columns, without their values.
    pub columns: Vec<LogColumn>,
    /// What was assumed, and what is left out; one line each.
    pub notes: Vec<String>,
    /// What could be determined.
    pub mapping: Mapping,
    /// What could not be determined.
    pub untold: Option<Undetermined>,
}

impl Proposal {
    /// Surveys the files in a folder.
    ///
    /// # Errors
    /// If a file cannot be read, or is not a log.
    pub fn new(folder: &Path, files: &[PathBuf], linkage: &Linkage) -> Result<Self, Error> {
        if files.iter().any(|file| file.ends_with(MANIFEST)) {
            check_files(folder)?;
            let campaign = Campaign::load_with(folder, linkage)?;
            return Ok(Self::Campaign {
                name: campaign.name,
                runs: campaign.runs.len(),
            });
        }
        let is_toml = |file: &&PathBuf| file.extension().is_some_and(|end| end == "toml");
        if let Some(file) = files.iter().find(is_toml) {
            let hint =
                "a campaign's manifest is named campaign.toml; delete other files of this kind";
            return Err(CampaignError::of_file(file, "is not a log", hint).into());
        }
        let mut files = Files::sort(files)?;
        let mut groups = Vec::new();
        if let Some(signals) = files.signals()? {
            let logs = files.logs.iter().enumerate();
            let buses = logs.filter(|(_, log)| is_bus(log));
            let logs = buses.map(|(index, _)| index).collect();
            add(&mut groups, Group::new(signals, logs));
        }
        for (index, log) in files.logs.iter().enumerate() {
            if let Some(found) = columns(log)? {
                add(&mut groups, Group::new(found, vec![index]));
            }
        }
        Ok(Self::Logs { files, groups })
    }

    /// The proposal as the page shows it.
    pub fn view(&self) -> Value {
        let (files, groups) = match self {
            Self::Campaign { name, runs } => return json!({ "campaign": name, "runs": runs }),
            Self::Logs { files, groups } => (files, groups),
        };
        let name = files.logs.first().and_then(|log| log.file_stem());
        let name = name.map_or_else(|| "campaign".into(), |name| name.to_string_lossy());
        let log = |log: &PathBuf| json!({ "file": file_name(log), "load_kg": load_in_name(log) });
        let signal = |(name, unit): (&'static str, &'static str)| {
            let units: Vec<&str> = usual_units(name).collect();
            json!({ "key": name, "unit": unit, "units": units, "raw": raw_units(name, &units), "title": title(name) })
        };
        json!({
            "name": name,
            "logs": files.logs.iter().map(log).collect::<Vec<_>>(),
            "groups": groups.iter().map(Group::view).collect::<Vec<_>>(),
            "signals": run_columns().map(signal).collect::<Vec<_>>(),
        })
    }
}

/// Checks that a campaign has no files outside its folder: nothing but the upload is read.
fn check_files(folder: &Path) -> Result<(), Error> {
    let outside = |file: &&PathBuf| file.parent() != Some(folder) || file.ends_with("..");
    match Campaign::files(folder)?.iter().find(outside) {
        None => Ok(()),
        Some(file) => {
            let named = file.strip_prefix(folder).unwrap_or(file);
            let what = format!("names the file {:?} in another folder", named.display());
            let hint = "open that file together with it, and name it without its folder";
            Err(CampaignError::of_file(&folder.join(MANIFEST), what, hint).into())
        }
    }
}

/// Name of a signal for a reader.
pub fn title(channel: &str) -> &str {
    match channel {
        "time_s" => "time",
        "lift_current_a" => "lift current",
        "lower_current_a" => "lowering current",
        "pump_pressure_bar" => "pump pressure",
        "cylinder_pressure_bar" => "cylinder pressure",
        "flow_lpm" => "flow",
        "rocker_angle_deg" => "rocker angle",
        "oil_temperature_c" => "oil temperature",
        other => other,
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

fn add(groups: &mut Vec<Group>, group: Group) {
    let alike = |known: &&mut Group| {
        (known.kind, &known.columns, &known.mapping) == (group.kind, &group.columns, &group.mapping)
            && (&known.untold, &known.notes) == (&group.untold, &group.notes)
    };
    match groups.iter_mut().find(alike) {
        Some(known) => {
            known.headings.extend(group.headings);
            known.logs.extend(group.logs);
        }
        None => groups.push(group),
    }
}

impl Group {
    fn new(found: Columns, logs: Vec<usize>) -> Self {
        let Columns {
            heading,
            kind,
            mut columns,
            mut notes,
        } = found;
        let (mapping, untold) = Mapping::draft(&columns, kind, &[]);
        notes.extend(mapping.notes.iter().map(|note| note.what.clone()));
        for column in &mut columns {
            column.values = Vec::new();
            column.lasts_s = None;
        }
        Self {
            headings: vec![heading],
            logs,
            kind,
            columns,
            notes,
            mapping,
            untold,
        }
    }

    /// Names of the columns that are neither taken nor named in a note.
    fn unused(&self) -> Vec<&str> {
        let is_taken = |name: &str| {
            let mut sources = self.mapping.taken.iter();
            sources.any(|taken| {
                let parts = check_source(taken.channel, &taken.source);
                parts.map_or(taken.source == name, |(known, _)| known == name)
            })
        };
        let is_noted = |name: &str| {
            let said = format!("left out: \"{name}\"");
            self.notes.iter().any(|note| note.starts_with(&said))
        };
        let names = self.columns.iter().map(|column| column.name.as_str());
        names
            .filter(|name| !is_taken(name) && !is_noted(name))
            .collect()
    }

    fn view(&self) -> Value {
        let column = |column: &LogColumn| json!({ "name": column.name, "unit": column.unit });
        let taken = |taken: &Taken| {
            let parts = check_source(taken.channel, &taken.source);
            let (name, unit) = parts.unwrap_or_else(|_| (taken.source.clone(), None));
            json!({
                "channel": taken.channel,
                "column": name,
                "unit": unit,
                "reason": taken.reason,
                "assumed": taken.is_assumed,
            })
        };
        let headings = self
            .headings
            .iter()
            .map(|heading| file_name(Path::new(heading)));
        json!({
            "files": headings.collect::<Vec<_>>(),
            "times": self.kind == Kind::Table,
            "own_units": self.kind == Kind::Signals,
            "columns": self.columns.iter().map(column).collect::<Vec<_>>(),
            "taken": self.mapping.taken.iter().map(taken).collect::<Vec<_>>(),
            "notes": self.notes,
            "unused": self.unused(),
            "untold": self.untold.as_ref().map(|untold| &untold.what),
        })
    }
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .unwrap_or_default()
        .to_string_lossy()
        .into_owned()
}
