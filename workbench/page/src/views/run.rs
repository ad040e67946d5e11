//! A run with its channels.

use hitch_plant::Channel;
use schemars::JsonSchema;
use serde::Serialize;

use crate::session::Session;
use hitch_results::report::run_views::conditions;
use hitch_results::web::plot::{LineNames, RunChannel, RunPlot, Samples, SimulatedChannel};

/// A run.
#[derive(Debug, Serialize, JsonSchema)]
pub struct RunView {
    /// Its index.
    pub run: usize,
    /// Its file.
    pub file: String,
    /// Load or port pressure, and oil temperature, as text.
    pub conditions: String,
    /// Its plot.
    #[serde(flatten)]
    pub plot: RunPlot<Vec<f64>, Samples>,
}

impl RunView {
    /// Measured and simulated channels of a run; `None` if there is no such run.
    pub fn of(session: &Session, index: usize) -> Option<Self> {
        let subject = session.subject();
        let ready = subject.experiment().runs.get(index)?;
        let evaluated = &session.present().evaluated;
        let simulated = evaluated.simulated(&subject.model, index);
        let second = session.second.as_ref();
        let other = second.map(|second| (second, second.evaluated.simulated(&second.model, index)));
        let shows_first = session.at() > 0 && second.is_none();
        let first = shows_first.then(|| subject.start.simulated(&subject.model, index));
        let channel = |channel: Channel| {
            Some(RunChannel {
                key: channel.key(),
                title: channel.title(),
                unit: channel.unit(),
                error: evaluated.error(index, channel),
                measured: Samples(ready.measured[channel.index()].clone()?),
                simulated: Samples::of(simulated.channel(channel)),
                residual: Samples(evaluated.residuals(index, channel)),
                first: first
                    .as_ref()
                    .map(|trace| Samples::of(trace.channel(channel))),
                first_residual: None,
                second: other.as_ref().map(|(second, trace)| SimulatedChannel {
                    simulated: Samples::of(trace.channel(channel)),
                    residual: Samples(second.evaluated.residuals(index, channel)),
                    error: second.evaluated.error(index, channel),
                }),
            })
        };
        let currents = &ready.drive.currents;
        let named = |second: &str| LineNames {
            second: Some(second.to_owned()),
            ..LineNames::default()
        };
        let plot = RunPlot {
            names: second.map(|second| named(&second.title)),
            time_s: ready.drive.time_s.clone(),
            lift_current_a: Samples(currents.iter().map(|current| current.lift_a).collect()),
            lower_current_a: Samples(currents.iter().map(|current| current.lower_a).collect()),
            channels: Channel::ALL.into_iter().filter_map(channel).collect(),
        };
        Some(Self {
            run: index,
            file: ready.file.clone(),
            conditions: conditions(ready),
            plot,
        })
    }
}
