//! The proposed next experiment: its runs, their currents, and what the models expect.

use hitch_campaign::Run;
use hitch_plant::Channel;
use maud::{Markup, html};

use super::chart::{Chart, Stroke};
use super::drawn::drawn;
use crate::explanation::{Next, TWO_LINES};

/// Runs and pictures of the proposed experiment; empty if no manoeuvre is proposed.
pub fn next_figure(next: &Next) -> Markup {
    let (Some(proposal), Some(detail)) = (&next.proposal, &next.next_experiment_detail) else {
        return html! {};
    };
    let expected: Vec<(&str, Vec<Run>)> = proposal
        .models
        .iter()
        .map(|of| (of.title.as_str(), proposal.expected(of)))
        .collect();
    html! {
        h2 { "The next experiment" }
        p { (detail.manoeuvre) "." }
        @if expected.len() > 1 {
            p { (TWO_LINES) }
        }
        @for (index, run) in detail.runs.iter().enumerate() {
            h3 { (format!("Run {}: {}", index + 1, run.conditions())) }
            (drawn(&format!("Currents and expected channels of run {}", index + 1), &charts(&expected, index)))
        }
    }
}

/// The currents of a run, then each channel as every model expects it.
fn charts(expected: &[(&str, Vec<Run>)], index: usize) -> Vec<Chart<'static>> {
    let runs: Vec<(&str, &Run)> = expected
        .iter()
        .filter_map(|(title, runs)| Some((*title, runs.get(index)?)))
        .collect();
    let Some((_, first)) = runs.first() else {
        return Vec::new();
    };
    let current = |name: &str, stroke, values: &Vec<f64>| {
        (
            name.to_owned(),
            stroke,
            (first.time_s.clone(), values.clone()),
        )
    };
    let currents = [
        current("lift current", Stroke::Lift, &first.lift_current_a),
        current("lowering current", Stroke::Lower, &first.lower_current_a),
    ];
    let currents = Chart::over_time("Currents", "current, A", currents);
    let channels = Channel::ALL.into_iter().filter_map(|channel| {
        let line = |((title, run), stroke): (&(&str, &Run), Stroke)| {
            let values = run.channel(channel)?.to_vec();
            Some(((*title).to_owned(), stroke, (run.time_s.clone(), values)))
        };
        let strokes = [Stroke::After, Stroke::Before];
        let lines: Vec<_> = runs.iter().zip(strokes).filter_map(line).collect();
        (!lines.is_empty()).then(|| Chart::over_time(channel.title(), axis(channel), lines))
    });
    std::iter::once(currents).chain(channels).collect()
}

/// Title of the axis of a channel.
fn axis(channel: Channel) -> &'static str {
    match channel {
        Channel::CylinderPressure | Channel::PumpPressure => "pressure, bar",
        Channel::Flow => "flow, l/min",
        Channel::RockerAngle => "angle, deg",
    }
}
