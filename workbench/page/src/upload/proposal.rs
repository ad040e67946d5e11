//! The proposed assignment of an upload's files.

use std::path::{Path, PathBuf};

use hitch_campaign::survey::{LogColumn, is_bus};
use hitch_campaign::{Campaign, CampaignError};
use hitch_plant::Linkage;

use hitch_output::error::Error;
use hitch_results::import::files::columns;
use hitch_results::import::{Columns, Files, Kind, Mapping, Undetermined};

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
}
