//! A proposed next experiment: as a sentence, and what the models expect of its runs.

use hitch_campaign::Run;
use hitch_identification::design::{Expecting, Proposal};
use hitch_plant::Channel;
use schemars::JsonSchema;
use serde::Serialize;

use hitch_results::explanation::{Next, PlannedRun, TWO_LINES};
use hitch_results::web::plot::{PlotLine, PlotRow, RowPlot, Samples};

/// Name, colour and dashes of the lines of the two models, in their order.
const LOOKS: [(&str, &str, Option<&str>); 2] = [
    ("model A", "simulated", None),
    ("model B", "second", Some("dash")),
];

/// A proposed experiment.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ProposedExperiment {
    /// Manoeuvre and purpose, as a sentence without a full stop.
    pub sentence: String,
    /// Whether there are runs to log.
    pub has_runs: bool,
}

/// What models expect of the runs of a proposed experiment.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ExpectedRuns {
    /// The models, in the order of their lines.
    pub models: Vec<ExpectingModel>,
    /// What the lines decide; `null` for a single model.
    pub decides: Option<&'static str>,
    /// The runs.
    pub runs: Vec<ExpectedRun>,
}

/// A model that expects something of the runs.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ExpectingModel {
    /// Name of its lines.
    pub name: &'static str,
    /// Title of the effect that it has, or that it is the present model.
    pub title: String,
}

/// A run to log.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ExpectedRun {
    /// Its load, start, oil temperature and duration.
    pub conditions: String,
    /// Its currents, and each channel as every model expects it.
    pub plot: RowPlot<Vec<f64>, Samples>,
}

impl ProposedExperiment {
    /// The experiment of a result; `None` without one.
    pub fn of(next: &Next) -> Option<Self> {
        next.next_experiment.clone().map(|sentence| Self {
            sentence,
            has_runs: next.proposal.is_some(),
        })
    }
}

impl ExpectedRuns {
    /// What the models of a proposal expect; simulates its runs.
    pub fn of(proposal: &Proposal, planned: &[PlannedRun]) -> Self {
        let models = proposal.models.iter().zip(LOOKS);
        let model = |(of, (name, ..)): (&Expecting, (&'static str, _, _))| ExpectingModel {
            name,
            title: of.title.clone(),
        };
        let expected: Vec<Vec<Run>> = models
            .clone()
            .map(|(of, _)| proposal.expected(of))
            .collect();
        let run = |(index, planned): (usize, &PlannedRun)| {
            let runs = expected.iter().filter_map(|runs| runs.get(index));
            Some(ExpectedRun {
                conditions: planned.conditions(),
                plot: plot(&runs.collect::<Vec<_>>())?,
            })
        };
        Self {
            models: models.map(model).collect(),
            decides: (expected.len() > 1).then_some(TWO_LINES),
            runs: planned.iter().enumerate().filter_map(run).collect(),
        }
    }
}

/// The currents of a run, then each channel as every model expects it; all have the same times.
fn plot(runs: &[&Run]) -> Option<RowPlot<Vec<f64>, Samples>> {
    let first = runs.first()?;
    let current = |name: &str, colour: &'static str, dash, values: &[f64]| PlotLine {
        name: name.to_owned(),
        key: colour.to_owned(),
        colour,
        dash,
        width: None,
        x: None,
        y: Samples::of(values),
    };
    let currents = PlotRow {
        title: "currents of the valves".to_owned(),
        unit: "A".to_owned(),
        height: None,
        lines: vec![
            current("lift current", "lift", None, &first.lift_current_a),
            current(
                "lowering current",
                "lower",
                Some("dash"),
                &first.lower_current_a,
            ),
        ],
    };
    let row = |channel: Channel| {
        let line = |(run, (name, colour, dash)): (&&Run, (&str, &'static str, _))| {
            Some(PlotLine {
                name: name.to_owned(),
                key: colour.to_owned(),
                colour,
                dash,
                width: Some(1.8),
                x: None,
                y: Samples::of(run.channel(channel)?),
            })
        };
        let lines: Vec<_> = runs.iter().zip(LOOKS).filter_map(line).collect();
        (!lines.is_empty()).then(|| PlotRow {
            title: channel.title().to_owned(),
            unit: channel.unit().to_owned(),
            height: None,
            lines,
        })
    };
    let channels = Channel::ALL.into_iter().filter_map(row);
    Some(RowPlot {
        x_title: "time, s".to_owned(),
        span: [*first.time_s.first()?, *first.time_s.last()?],
        time_s: first.time_s.clone(),
        rows: std::iter::once(currents).chain(channels).collect(),
    })
}
