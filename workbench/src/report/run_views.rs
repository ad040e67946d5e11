//! Converts evaluated models into the runs of a report.

use hitch_campaign::Bench;
use hitch_identification::data::experiment::ReadyRun;
use hitch_plant::{Channel, Model};

use super::runs::{ChannelView, RunView};
use crate::comparison::Evaluated;

/// The runs of a campaign: measured, simulated by the initial model, and simulated by the final model.
pub fn run_views(model: &Model, before: &Evaluated, after: Option<&Evaluated>) -> Vec<RunView> {
    let view = |index: usize| {
        let run = &before.experiment.runs[index];
        RunView {
            file: run.file.clone(),
            conditions: conditions(run),
            time_s: run.drive.time_s.clone(),
            channels: channel_views(model, index, before, after),
        }
    };
    (0..before.experiment.runs.len()).map(view).collect()
}

fn channel_views(
    model: &Model,
    run: usize,
    before: &Evaluated,
    after: Option<&Evaluated>,
) -> Vec<ChannelView> {
    let simulated = before.simulated(model, run);
    let simulated_after = after.map(|after| after.simulated(model, run));
    let view = |channel: Channel| {
        Some(ChannelView {
            channel,
            measured: before.experiment.runs[run].measured[channel.index()].clone()?,
            before: simulated.channel(channel).to_vec(),
            after: simulated_after
                .as_ref()
                .map(|trace| trace.channel(channel).to_vec()),
            error_before: before.error(run, channel),
            error_after: after.map(|after| after.error(run, channel)),
        })
    };
    Channel::ALL.into_iter().filter_map(view).collect()
}

/// Load or port pressure, and oil temperature, as text.
pub fn conditions(run: &ReadyRun) -> String {
    let bench = match run.bench {
        Bench::Hitch { load_kg } => format!("{load_kg:.0} kg"),
        Bench::Flow { port_pressure_bar } => format!("flow bench at {port_pressure_bar:.0} bar"),
    };
    match run.oil_temperature_known {
        true => format!("{bench}, oil at {:.0} °C", run.oil_temperature_c),
        false => format!("{bench}, oil temperature not measured"),
    }
}
