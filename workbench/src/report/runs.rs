//! Charts of measured and simulated channels, run by run.

use hitch_plant::Channel;
use maud::{Markup, html};

use super::chart::{Chart, Line, Stroke, legend};

/// Number of runs that are initially unfolded.
const OPEN_RUNS: usize = 2;

/// One run as the report draws it.
#[derive(Debug, Clone)]
pub struct RunView {
    /// File of the log.
    pub file: String,
    /// Load or port pressure, and oil temperature, as text.
    pub conditions: String,
    /// Time stamps, s.
    pub time_s: Vec<f64>,
    /// The measured channels.
    pub channels: Vec<ChannelView>,
}

/// One channel of a run.
#[derive(Debug, Clone)]
pub struct ChannelView {
    /// The channel.
    pub channel: Channel,
    /// Measured, in the channel's unit.
    pub measured: Vec<f64>,
    /// Simulated by the initial model.
    pub before: Vec<f64>,
    /// Simulated by the final model, if it differs.
    pub after: Option<Vec<f64>>,
    /// Error before, in sigma.
    pub error_before: f64,
    /// Error after, in sigma.
    pub error_after: Option<f64>,
}

/// All runs, in descending order of error; the first ones unfolded.
pub fn runs(views: &[RunView]) -> Markup {
    let changed = views
        .iter()
        .flat_map(|view| &view.channels)
        .any(|channel| channel.after.is_some());
    let mut entries = vec![
        (Stroke::Measured, "measured"),
        (Stroke::Before, "model before"),
    ];
    if changed {
        entries.push((Stroke::After, "model after"));
    }
    html! {
        (legend(&entries))
        @for (place, view) in by_error(views).into_iter().enumerate() { (run(view, place < OPEN_RUNS)) }
    }
}

fn by_error(views: &[RunView]) -> Vec<&RunView> {
    let worst = |view: &RunView| {
        view.channels
            .iter()
            .map(|channel| channel.error_before)
            .fold(0.0, f64::max)
    };
    let mut sorted: Vec<&RunView> = views.iter().collect();
    sorted.sort_by(|a, b| worst(b).total_cmp(&worst(a)));
    sorted
}

fn run(view: &RunView, open: bool) -> Markup {
    html! { details open[open] {
        summary { (view.file) " " span.note { (view.conditions) } }
        div.grid { @for channel in &view.channels { (figure(view, channel)) } }
    } }
}

fn figure(view: &RunView, channel: &ChannelView) -> Markup {
    let line = |name, stroke, y| Line {
        name,
        stroke,
        x: &view.time_s,
        y,
    };
    let mut lines = vec![
        line("measured", Stroke::Measured, &channel.measured),
        line("before", Stroke::Before, &channel.before),
    ];
    if let Some(after) = &channel.after {
        lines.push(line("after", Stroke::After, after));
    }
    let after = channel
        .error_after
        .map_or(String::new(), |error| format!(" → {error:.2}"));
    let title = format!("{}, {}", channel.channel.title(), channel.channel.unit());
    Chart {
        caption: format!(
            "{}: error {:.2}{after} sigma",
            channel.channel.title(),
            channel.error_before
        ),
        x_title: "time, s",
        y_title: &title,
        lines,
    }
    .figure()
}
