//! A finding: a fault of the measurement, where it is, how large it is, and its cure.

use hitch_campaign::Campaign;
use hitch_plant::Channel;
use schemars::JsonSchema;
use serde::Serialize;

use crate::statistics::median;

/// Kind of a fault of the measurement.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// A logged current does not read zero where its valve is shut.
    CurrentZero,
    /// The samples of a channel are equal at the largest or smallest value it has.
    Saturated,
    /// The samples of a channel are zero around zero.
    DeadBand,
    /// The samples of a channel are equal at values between its extremes.
    Held,
    /// Single samples far off both their neighbours.
    Spikes,
    /// The sign of the flow contradicts the valves.
    FlowSign,
    /// The direction of the angle contradicts the valves.
    AngleSign,
    /// The angle stays while the valves move the hitch.
    NoMotion,
    /// The cylinder pressure stays near zero while the hitch is lifted.
    DeadPressure,
    /// The pressures of a run are in another unit.
    PressureUnit,
    /// The stated load contradicts the pressure at rest.
    Load,
    /// The pump pressure is below the cylinder pressure while the hitch is lifted.
    PumpBelowCylinder,
    /// Two runs have the same samples.
    RepeatedRun,
    /// A channel follows the currents after a dead time.
    Delay,
    /// The oil temperature changes within a run.
    OilTemperature,
    /// A logged current scatters more when it flows than when it does not.
    CurrentRipple,
    /// The samples are too far apart for fast effects.
    SampleInterval,
    /// The steps of a channel are larger than its noise.
    Resolution,
}

/// The size of a fault.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, JsonSchema)]
pub struct Evidence {
    /// The figure.
    pub value: f64,
    /// Its accuracy, in the same unit.
    pub accuracy: f64,
    /// Its unit; empty for a ratio.
    pub unit: &'static str,
}

/// A fault that the logs alone show.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Finding {
    /// Kind of the fault.
    pub kind: Kind,
    /// File of the run; absent if it is in all runs.
    pub run: Option<String>,
    /// Key of the channel or current; absent if it is in all of them.
    pub channel: Option<&'static str>,
    /// Time of its first sample, s, as logged; absent if it lasts the whole run.
    pub from_s: Option<f64>,
    /// Time of its last sample, s, as logged; absent if it lasts the whole run.
    pub to_s: Option<f64>,
    /// Its size.
    pub evidence: Evidence,
    /// What is seen, one sentence.
    pub seen: String,
    /// Suggested correction, one sentence.
    pub cure: String,
}

impl Finding {
    /// A finding in all runs and channels, for their whole time.
    pub(crate) fn new(kind: Kind, evidence: Evidence, seen: String, cure: &str) -> Self {
        Self {
            kind,
            run: None,
            channel: None,
            from_s: None,
            to_s: None,
            evidence,
            seen,
            cure: cure.to_owned(),
        }
    }

    /// The same, in one run of a campaign.
    pub(crate) fn in_run(mut self, campaign: &Campaign, run: usize) -> Self {
        self.run = Some(campaign.runs[run].file.clone());
        self
    }

    /// Whether it concerns a run.
    pub(crate) fn is_in(&self, campaign: &Campaign, run: usize) -> bool {
        self.run
            .as_ref()
            .is_none_or(|file| *file == campaign.runs[run].file)
    }

    /// The same, in the channel or current with this key.
    pub(crate) fn of(mut self, key: &'static str) -> Self {
        self.channel = Some(key);
        self
    }

    /// The same, in a stretch of time, s.
    pub(crate) fn between(mut self, from_s: f64, to_s: f64) -> Self {
        (self.from_s, self.to_s) = (Some(from_s), Some(to_s));
        self
    }
}

impl Evidence {
    /// A figure with its accuracy, in a unit.
    pub(crate) const fn new(value: f64, accuracy: f64, unit: &'static str) -> Self {
        Self {
            value,
            accuracy,
            unit,
        }
    }

    /// A figure in the unit of a channel.
    pub(crate) const fn of(value: f64, accuracy: f64, channel: Channel) -> Self {
        Self::new(value, accuracy, channel.unit())
    }
}

/// The findings of the runs whose figure is wrong: one of its median if it is wrong in all of several runs that show it, else one for each.
pub(crate) fn by_run(
    campaign: &Campaign,
    figure: impl Fn(usize) -> Option<f64>,
    is_wrong: impl Fn(f64) -> bool,
    finding: impl Fn(f64) -> Finding,
) -> Vec<Finding> {
    let runs = 0..campaign.runs.len();
    let shown: Vec<(usize, f64)> = runs.filter_map(|run| Some((run, figure(run)?))).collect();
    let wrong = || shown.iter().filter(|shown| is_wrong(shown.1));
    if shown.len() > 1 && wrong().count() == shown.len() {
        return vec![finding(median(shown.iter().map(|shown| shown.1)))];
    }
    wrong()
        .map(|&(run, value)| finding(value).in_run(campaign, run))
        .collect()
}

/// The findings in runs that no other finding names.
pub(crate) fn unexplained(findings: Vec<Finding>, others: &[Finding]) -> Vec<Finding> {
    let named = |finding: &Finding| others.iter().any(|other| other.run == finding.run);
    findings
        .into_iter()
        .filter(|finding| !named(finding))
        .collect()
}
