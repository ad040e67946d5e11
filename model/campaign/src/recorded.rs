//! What was recorded: the runs of a campaign, their test stands and instruments.

use hitch_input::input_error::InputError;
use hitch_plant::{Channel, HitchRig, Rig, units};

/// A fault of a campaign, with file, line and column.
pub type CampaignError = InputError;

/// A set of runs measured on one rig.
#[derive(Debug, Clone, PartialEq)]
pub struct Campaign {
    /// Short name; the folder's name by default.
    pub name: String,
    /// One sentence; empty by default.
    pub description: String,
    /// Sample rate, Hz; by default that of the first run's time column.
    pub sample_rate_hz: f64,
    /// Whether one clock stamps the currents and all channels, so that no channel has a clock offset.
    pub synchronous: bool,
    /// Noise of the instruments.
    pub noise: Noise,
    /// The runs, in the order of `campaign.toml`; at least one.
    pub runs: Vec<Run>,
}

/// Noise of each instrument from its data sheet: standard deviation, in the instrument's unit; `None` if it has to be
/// estimated.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Noise {
    /// Logged current of the lift solenoid, A.
    pub lift_current_a: Option<f64>,
    /// Logged current of the lowering solenoid, A.
    pub lower_current_a: Option<f64>,
    /// Measured channels, by [`Channel::index`].
    pub channels: [Option<f64>; 4],
    /// Oil temperature, degrees Celsius.
    pub oil_temperature_c: Option<f64>,
}

/// Test stand of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bench {
    /// Cylinder, linkage and a load at the hitch.
    Hitch {
        /// Load at the hitch as weighed, without the links' own weight, kg.
        load_kg: f64,
    },
    /// No cylinder: the cylinder port is at a constant pressure, and the flow through it is measured.
    Flow {
        /// Pressure at the port, bar.
        port_pressure_bar: f64,
    },
}

/// One log: the valve currents and the measured channels.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// File name relative to the campaign's folder, or of a log elsewhere, with the time span if the run is a part of
    /// it.
    pub file: String,
    /// Test stand of the run.
    pub bench: Bench,
    /// Oil temperature of the run, degrees Celsius: of the manifest, else the mean of the log, else 40.
    pub oil_temperature_c: f64,
    /// Whether the oil temperature is stated or logged, and not assumed.
    pub oil_temperature_known: bool,
    /// Time stamps as logged, s; strictly increasing, at least [`Run::FEWEST_SAMPLES`].
    pub time_s: Vec<f64>,
    /// Current of the lift solenoid, A; short dropouts are filled, so no value is missing.
    pub lift_current_a: Vec<f64>,
    /// Current of the lowering solenoid, A; short dropouts are filled, so no value is missing.
    pub lower_current_a: Vec<f64>,
    /// Measured channels by [`Channel::index`], in the channel's unit; `None` if the channel was not measured or has no
    /// values, NaN at a dropout. A flow bench has no rocker: its angle is always `None`.
    pub channels: [Option<Vec<f64>>; 4],
    /// Logged oil temperature, degrees Celsius; NaN at a dropout.
    pub oil_temperature_log_c: Option<Vec<f64>>,
}

impl Bench {
    /// The simulated rig; one of a hitch starts at this rocker angle, rad.
    #[must_use]
    pub fn rig(self, start_angle_rad: f64) -> Rig {
        match self {
            Self::Hitch { load_kg } => Rig::Hitch(HitchRig {
                load_kg,
                start_angle_rad,
            }),
            Self::Flow { port_pressure_bar } => Rig::Flow {
                port_pressure_pa: units::pa_from_bar(port_pressure_bar),
            },
        }
    }
}

impl Noise {
    /// Declared sigma of a channel, in the channel's unit.
    pub fn of(&self, channel: Channel) -> Option<f64> {
        self.channels[channel.index()]
    }
}

impl Run {
    /// Fewest samples of a run.
    pub const FEWEST_SAMPLES: usize = 10;

    /// Samples of a channel, in its unit, NaN at a dropout; `None` if it was not measured.
    pub fn channel(&self, channel: Channel) -> Option<&[f64]> {
        self.channels[channel.index()].as_deref()
    }

    /// Time from the first to the last sample, s.
    pub fn duration_s(&self) -> f64 {
        self.time_s
            .last()
            .zip(self.time_s.first())
            .map_or(0.0, |(last, first)| last - first)
    }
}
