//! The report of `hitch compare`.
use hitch_model::Model;
use hitch_model::campaign::{Bench, Channel};
use maud::{Markup, html};

use super::page;
use super::runs::{ChannelView, RunView, runs};
use crate::comparison::{Comparison, Evaluated, Grouping};

/// The report as one HTML document.
pub fn page(comparison: &Comparison, evaluated: &Evaluated, model: &Model) -> String {
    let views = run_views(evaluated, model);
    let title = format!("{} against {}", comparison.model, comparison.campaign);
    let content = html! {
        h1 { (title) }
        p.lead { "Error " strong { (format!("{:.2}", comparison.error)) } " sigma; a perfect model has 1.00, the noise of the instruments." }
        h2 { "By channel" }
        (channels(comparison))
        (grids(comparison))
        h2 { "Measured against simulated" }
        (runs(&views))
    };
    page::page(&title, &content)
}

/// Tables of the error in sigma, one a grouping.
pub fn grids(comparison: &Comparison) -> Markup {
    html! { @for by in Grouping::ALL {
        h2 { "Error in sigma " (by.title()) }
        (comparison.grid(by).table())
    } }
}

/// The runs as a report draws them, without a second model.
pub fn run_views(evaluated: &Evaluated, model: &Model) -> Vec<RunView> {
    (0..evaluated.experiment.runs.len())
        .map(|run| run_view(evaluated, model, run))
        .collect()
}

fn run_view(evaluated: &Evaluated, model: &Model, index: usize) -> RunView {
    let run = &evaluated.experiment.runs[index];
    let mut trace = evaluated.simulated(model, index);
    let view = |channel: Channel| {
        let measured = run.measured[channel.index()].clone()?;
        Some(ChannelView {
            channel,
            measured,
            before: std::mem::take(&mut trace.channels[channel.index()]),
            after: None,
            error_before: rms(&evaluated.residuals(index, channel)),
            error_after: None,
        })
    };
    let channels = Channel::ALL.into_iter().filter_map(view).collect();
    let conditions = conditions(run.bench, run.oil_temperature_c);
    RunView {
        file: run.file.clone(),
        conditions,
        time_s: run.drive.time_s.clone(),
        channels,
    }
}

fn conditions(bench: Bench, oil_temperature_c: f64) -> String {
    let bench = match bench {
        Bench::Hitch { load_kg } => format!("{load_kg:.0} kg"),
        Bench::Flow { port_pressure_bar } => format!("flow bench at {port_pressure_bar:.0} bar"),
    };
    format!("{bench}, oil at {oil_temperature_c:.0} °C")
}

fn rms(residuals: &[f64]) -> f64 {
    let compared: Vec<f64> = residuals
        .iter()
        .copied()
        .filter(|residual| residual.is_finite())
        .collect();
    (compared
        .iter()
        .map(|residual| residual * residual)
        .sum::<f64>()
        / compared.len().max(1) as f64)
        .sqrt()
}

fn channels(comparison: &Comparison) -> Markup {
    let row = |channel: &crate::comparison::ChannelError| {
        let numbers =
            [channel.error, channel.rms, channel.noise].map(|number| format!("{number:.3}"));
        let rest = [channel.unit.to_owned(), channel.samples.to_string()];
        [channel.channel.to_owned()]
            .into_iter()
            .chain(numbers)
            .chain(rest)
            .collect()
    };
    let rows: Vec<Vec<String>> = comparison.channels.iter().map(row).collect();
    page::table(
        &["channel", "error, sigma", "rms", "noise", "unit", "samples"],
        &rows,
    )
}
