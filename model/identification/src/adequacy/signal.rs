//! The signals that the remaining error may depend on.

use std::fmt;

use hitch_campaign::Bench;
use hitch_plant::Channel;

use crate::data::experiment::Experiment;
use crate::data::ready_run::ReadyRun;

/// A measured or commanded quantity of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Signal {
    /// Rocker angle, degree.
    RockerAngle,
    /// Cylinder pressure, bar.
    CylinderPressure,
    /// Flow into the cylinder, l/min.
    Flow,
    /// Current of the lift valve, A.
    LiftCurrent,
    /// Current of the lowering valve, A.
    LowerCurrent,
    /// Load on the hitch, kg.
    Load,
    /// Oil temperature, degree Celsius.
    OilTemperature,
    /// Time since the start of the run, s.
    Time,
}

impl Signal {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::RockerAngle,
        Self::CylinderPressure,
        Self::Flow,
        Self::LiftCurrent,
        Self::LowerCurrent,
        Self::Load,
        Self::OilTemperature,
        Self::Time,
    ];

    /// Name with its unit, as in logs.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::RockerAngle => Channel::RockerAngle.key(),
            Self::CylinderPressure => Channel::CylinderPressure.key(),
            Self::Flow => Channel::Flow.key(),
            Self::LiftCurrent => "lift_current_a",
            Self::LowerCurrent => "lower_current_a",
            Self::Load => "load_kg",
            Self::OilTemperature => "oil_temperature_c",
            Self::Time => "time_s",
        }
    }

    /// Its samples over all runs, in its unit; NaN where it was not measured.
    #[must_use]
    pub fn samples(self, experiment: &Experiment) -> Vec<f64> {
        let of_run = |run| (0..ReadyRun::len(run)).map(move |sample| self.at(run, sample));
        experiment.runs.iter().flat_map(of_run).collect()
    }

    fn at(self, run: &ReadyRun, sample: usize) -> f64 {
        let measured = |channel: Channel| {
            let samples = run.measured[channel.index()].as_ref();
            samples.map_or(f64::NAN, |samples| samples[sample])
        };
        match self {
            Self::RockerAngle => measured(Channel::RockerAngle),
            Self::CylinderPressure => measured(Channel::CylinderPressure),
            Self::Flow => measured(Channel::Flow),
            Self::LiftCurrent => run.drive.currents[sample].lift_a,
            Self::LowerCurrent => run.drive.currents[sample].lower_a,
            Self::Load => match run.bench {
                Bench::Hitch { load_kg } => load_kg,
                Bench::Flow { .. } => f64::NAN,
            },
            Self::OilTemperature => run.oil_temperature_c,
            Self::Time => run.drive.time_s[sample],
        }
    }
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.key())
    }
}
