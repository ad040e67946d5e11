//! Converts evaluated models into the runs of a report.

use hitch_campaign::Bench;
use hitch_identification::data::ready_run::ReadyRun;
use hitch_plant::simulation::Trace;
use hitch_plant::{Channel, Model};

use super::run_view::{ChannelView, RunView};
use crate::comparison::Evaluated;
use crate::web::plot::SimulatedChannel;

/// A model, and its evaluation.
pub type State<'a> = (&'a Model, &'a Evaluated);

/// The runs of a campaign: measured, simulated by the initial model, and simulated by the final model.
pub fn run_views(before: State<'_>, after: Option<State<'_>>) -> Vec<RunView> {
    let experiment = &before.1.experiment;
    let view = |index: usize| {
        let run = &experiment.runs[index];
        let currents = &run.drive.currents;
        RunView {
            index,
            file: run.file.clone(),
            conditions: conditions(run),
            time_s: run.drive.time_s.clone(),
            lift_current_a: currents.iter().map(|current| current.lift_a).collect(),
            lower_current_a: currents.iter().map(|current| current.lower_a).collect(),
            channels: channel_views(index, before, after),
        }
    };
    (0..experiment.runs.len()).map(view).collect()
}

fn channel_views(run: usize, before: State<'_>, after: Option<State<'_>>) -> Vec<ChannelView> {
    let experiment = &before.1.experiment;
    let traces = [Some(before), after].map(|state| {
        let (model, evaluated) = state?;
        Some((evaluated, evaluated.simulated(model, run)))
    });
    let simulated = |of: &Option<(&Evaluated, Trace)>, channel: Channel| {
        let (evaluated, trace) = of.as_ref()?;
        Some(SimulatedChannel {
            simulated: trace.channel(channel).to_vec(),
            residual: evaluated.residuals(run, channel),
            error: evaluated.error(run, channel),
        })
    };
    let view = |channel: Channel| {
        Some(ChannelView {
            channel,
            noise: experiment.noise[channel.index()],
            measured: experiment.runs[run].measured[channel.index()].clone()?,
            before: simulated(&traces[0], channel)?,
            after: simulated(&traces[1], channel),
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
    if run.oil_temperature_known {
        format!("{bench}, oil at {:.0} °C", run.oil_temperature_c)
    } else {
        format!("{bench}, oil temperature not measured")
    }
}
