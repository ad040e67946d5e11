//! The runs of a proposed experiment, and their current profiles as files for a test stand.

use std::fmt::Write as _;

use hitch_campaign::Bench;
use hitch_identification::design::Proposal;
use hitch_identification::design::plan::{RunPlan, Stand};
use hitch_model_file::quoted;
use hitch_plant::Model;
use schemars::JsonSchema;
use serde::Serialize;

use crate::import::run_block::RunBlock;
use hitch_output::text::{joined, known};

/// Sample rate of a file of currents, Hz.
const PROFILE_HZ: f64 = 100.0;

/// A run to log.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct PlannedRun {
    /// Load at the hitch, kg; `None` on a flow bench.
    pub load_kg: Option<f64>,
    /// Pressure at the cylinder port of a flow bench, bar; `None` on the hitch.
    pub port_pressure_bar: Option<f64>,
    /// Rocker angle at the start, degrees; `None` on a flow bench.
    pub start_angle_deg: Option<f64>,
    /// Oil temperature, degrees Celsius.
    pub oil_temperature_c: f64,
    /// Duration, s, with a rest without current at its start.
    pub duration_s: f64,
    /// Its currents: ramps and plateaus, after the rest.
    pub currents: Vec<PlannedCurrents>,
}

/// A linear ramp to these currents, then a plateau.
#[derive(Debug, Clone, Copy, Serialize, JsonSchema)]
pub struct PlannedCurrents {
    /// Duration of the ramp, s.
    pub ramp_s: f64,
    /// Duration of the plateau, s.
    pub stay_s: f64,
    /// Current of the lift valve, A.
    pub lift_current_a: f64,
    /// Current of the lowering valve, A.
    pub lower_current_a: f64,
}

impl PlannedRun {
    /// Its load, start, oil temperature and duration, in words.
    #[must_use]
    pub fn conditions(&self) -> String {
        let parts = [
            self.load_kg.map(|kg| format!("{} kg", known(kg, 0))),
            self.port_pressure_bar
                .map(|bar| format!("flow bench at {} bar", known(bar, 0))),
            self.start_angle_deg
                .map(|deg| format!("from {} deg", known(deg, 1))),
            Some(format!("oil at {} °C", known(self.oil_temperature_c, 0))),
            Some(format!("{} s", known(self.duration_s, 0))),
        ];
        joined(parts.into_iter().flatten(), ", ")
    }
}

/// The runs of a proposal.
pub fn planned(proposal: &Proposal) -> Vec<PlannedRun> {
    let runs = &proposal.manoeuvre.runs;
    let model = proposal.models.first().map(|expecting| &expecting.model);
    runs.iter().map(|run| planned_run(run, model)).collect()
}

fn planned_run(run: &RunPlan, model: Option<&Model>) -> PlannedRun {
    let (load_kg, port_pressure_bar) = match run.stand {
        Stand::Hitch { load_kg, .. } => (Some(load_kg), None),
        Stand::Flow { port_pressure_bar } => (None, Some(port_pressure_bar)),
    };
    let start = |model: &Model| run.start_rad(model).map(f64::to_degrees);
    let currents = run.course.iter().map(|segment| PlannedCurrents {
        ramp_s: segment.ramp_s,
        stay_s: segment.stay_s,
        lift_current_a: segment.to.lift_a,
        lower_current_a: segment.to.lower_a,
    });
    PlannedRun {
        load_kg,
        port_pressure_bar,
        start_angle_deg: model.and_then(start),
        oil_temperature_c: run.oil_temperature_c,
        duration_s: run.duration_s(),
        currents: currents.collect(),
    }
}

/// Names and texts of the files of a proposal: the currents of each run over time, and the campaign that its logs become.
///
/// The logs are to be saved beside `campaign.toml`, under the names that it states.
pub fn files(proposal: &Proposal) -> Vec<(String, String)> {
    let manoeuvre = &proposal.manoeuvre;
    let name = manoeuvre.name;
    let mut campaign = format!(
        "# Runs that are still to be logged: the currents are in the folder currents. Save each log under the name in `file`.\n\
         format = 1\nname = {}\ndescription = {}\n",
        quoted(name),
        quoted(&manoeuvre.instruction)
    );
    let mut files = Vec::new();
    for (index, run) in manoeuvre.runs.iter().enumerate() {
        let file = format!("{name}_{}.csv", index + 1);
        let block = RunBlock {
            file: &file,
            then: &[],
            bench: bench(run.stand),
            oil_temperature_c: Some(run.oil_temperature_c),
            span_s: None,
        };
        campaign += &block.to_string();
        files.push((format!("currents/{file}"), profile(run)));
    }
    files.push(("campaign.toml".to_owned(), campaign));
    files
}

fn bench(stand: Stand) -> Bench {
    match stand {
        Stand::Hitch { load_kg, .. } => Bench::Hitch { load_kg },
        Stand::Flow { port_pressure_bar } => Bench::Flow { port_pressure_bar },
    }
}

/// The currents of a run over time, as CSV. (Writing to a string cannot fail.)
fn profile(run: &RunPlan) -> String {
    let mut text = String::from("time_s,lift_current_a,lower_current_a\n");
    for time_s in run.time_s(PROFILE_HZ) {
        let currents = run.currents(time_s);
        let _ = writeln!(
            text,
            "{time_s:.2},{:.4},{:.4}",
            currents.lift_a, currents.lower_a
        );
    }
    text
}
