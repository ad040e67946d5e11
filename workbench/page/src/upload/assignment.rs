//! The assignment as edited by the user, and the campaign that it makes.

use std::path::Path;

use hitch_campaign::survey::{check_source, fits, run_columns};
use hitch_campaign::{Bench, Campaign, CampaignError};
use hitch_plant::Linkage;
use serde::Deserialize;

use super::proposal::{Group, MANIFEST, Proposal, title};
use hitch_output::error::Error;
use hitch_results::import::manifest::{Log, campaign, path_from};
use hitch_results::import::{Kind, Mapping};

/// The edited assignment; its lists are those of the proposal.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct Assignment {
    /// Name of the campaign.
    name: String,
    groups: Vec<Vec<Source>>,
    logs: Vec<Stand>,
}

/// The source of a column of a run.
#[derive(Debug, Clone, Deserialize)]
struct Source {
    channel: String,
    column: String,
    /// `None` if the log states it.
    unit: Option<String>,
    /// Two known points of a sensor, each its reading and the value of the signal.
    points: Option<[[f64; 2]; 2]>,
}

impl Source {
    /// Why values of the column are not those of the signal; `None` if the unit tells how to convert them.
    fn lacks_unit(&self, group: &Group) -> Option<String> {
        if self.points.is_some() {
            return None;
        }
        let column = group.columns.iter().find(|one| one.name == self.column)?;
        let unit = self.unit.as_deref().or(column.unit.as_deref());
        // A voltage or a percentage fits every signal, but needs two points.
        let converts = |unit: &str| {
            let source = format!("{}:{unit}", self.column);
            check_source(&self.channel, &source).is_ok()
        };
        match unit {
            Some(unit) if fits(unit, &self.channel) && converts(unit) => None,
            Some(unit) => Some(format!(
                "\"{}\" is in {unit}, which is not a unit of {}",
                self.column,
                title(&self.channel)
            )),
            // A column with the name of a run's column has its unit in the name.
            None if run_columns().any(|(known, _)| known == self.column) => None,
            None => Some(format!("the log states no unit of \"{}\"", self.column)),
        }
    }

    /// As it is written in a manifest.
    fn written(&self) -> String {
        let unit = self.unit.as_deref();
        match (self.points, unit) {
            (Some([first, second]), _) => format!(
                "{}:{} {}={} {}={}",
                self.column,
                unit.unwrap_or_default(),
                first[0],
                first[1],
                second[0],
                second[1]
            ),
            (None, Some(unit)) => format!("{}:{unit}", self.column),
            (None, None) => self.column.clone(),
        }
    }
}

/// The test stand of a log.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(tag = "bench", rename_all = "lowercase")]
enum Stand {
    Hitch { load_kg: Option<f64> },
    Flow { port_pressure_bar: Option<f64> },
}

impl Assignment {
    /// Reads the campaign. Beside it, which logs are joined, split or cut; one line each.
    ///
    /// # Errors
    /// If the assignment or a file is invalid.
    pub fn campaign(
        &self,
        folder: &Path,
        proposal: &Proposal,
        linkage: &Linkage,
    ) -> Result<(Campaign, Vec<String>), Error> {
        let (files, groups) = match proposal {
            Proposal::Campaign { .. } => {
                return Ok((Campaign::load_with(folder, linkage)?, Vec::new()));
            }
            Proposal::Logs { files, groups } => (files, groups),
        };
        if groups.len() != self.groups.len() || files.logs.len() != self.logs.len() {
            let what = "the assignment is not that of these files; open them again";
            return Err(Error::Usage(what.to_owned()));
        }
        let mut mappings: Vec<Option<Mapping>> = vec![None; files.logs.len()];
        let mut signals = None;
        for (group, given) in groups.iter().zip(&self.groups) {
            let mapping = mapping(group, given)?;
            if group.kind == Kind::Signals {
                signals = Some(mapping);
                continue;
            }
            for &log in &group.logs {
                mappings[log] = Some(mapping.clone());
            }
        }
        let mut logs = Vec::with_capacity(files.logs.len());
        for ((file, mapping), stand) in files.logs.iter().zip(mappings).zip(&self.logs) {
            logs.push(Log {
                file: path_from(folder, file),
                mapping,
                bench: stand.bench(file)?,
                then: Vec::new(),
                cuts: Vec::new(),
            });
        }
        let can = files.can(folder, signals.as_ref());
        let read = campaign(folder, self.name(), can.as_deref(), logs, linkage);
        read.map(|(_, campaign, notes)| (campaign, notes))
            .map_err(|error| unplaced(folder, error))
    }

    fn name(&self) -> &str {
        let name = self.name.trim();
        if name.is_empty() { "campaign" } else { name }
    }
}

/// A fault without its position in the manifest, which the user does not see.
fn unplaced(folder: &Path, error: Error) -> Error {
    match error {
        Error::Input(input) if input.file == folder.join(MANIFEST) => {
            Error::Usage(format!("{}; {}", input.what, input.hint))
        }
        other => other,
    }
}

fn mapping(group: &Group, given: &[Source]) -> Result<Mapping, Error> {
    let heading = group.headings.first().map_or("", String::as_str);
    for source in given {
        if let Some(what) = source.lacks_unit(group) {
            let hint = "choose its unit in the table; for the raw values of a sensor, choose \"V, two known points\" or another raw \
                        unit and enter two readings with their true values";
            return Err(CampaignError::of_file(Path::new(heading), what, hint).into());
        }
    }
    let named = given
        .iter()
        .map(|given| (given.channel.clone(), given.written()));
    let named: Vec<(String, String)> = named.collect();
    Mapping::given(&group.columns, group.kind, &named).map_err(|untold| {
        CampaignError::of_file(Path::new(heading), untold.what, "assign it in the table").into()
    })
}

impl Stand {
    fn bench(self, log: &Path) -> Result<Bench, Error> {
        let missing = |what: &str, hint: &str| CampaignError::of_file(log, what, hint);
        Ok(match self {
            Self::Hitch { load_kg } => Bench::Hitch {
                load_kg: load_kg
                    .ok_or_else(|| missing("the load at the hitch is missing", "enter it in kg"))?,
            },
            Self::Flow { port_pressure_bar } => Bench::Flow {
                port_pressure_bar: port_pressure_bar.ok_or_else(|| {
                    missing(
                        "the port pressure of the flow bench is missing",
                        "enter it in bar",
                    )
                })?,
            },
        })
    }
}
