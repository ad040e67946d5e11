//! A run as the report shows it.

use hitch_plant::Channel;

/// One run as the report draws it.
#[derive(Debug, Clone)]
pub struct RunView {
    /// Index in the campaign.
    pub index: usize,
    /// File of the log.
    pub file: String,
    /// Load or port pressure, and oil temperature, as text.
    pub conditions: String,
    /// Time stamps, s.
    pub time_s: Vec<f64>,
    /// Current of the lift valve, A.
    pub lift_current_a: Vec<f64>,
    /// Current of the lowering valve, A.
    pub lower_current_a: Vec<f64>,
    /// The measured channels.
    pub channels: Vec<ChannelView>,
}

/// A simulated channel.
#[derive(Debug, Clone)]
pub struct Simulated {
    /// Samples, in the channel's unit.
    pub samples: Vec<f64>,
    /// Residuals, sigma; NaN where not compared.
    pub residuals: Vec<f64>,
    /// Error, sigma.
    pub error: f64,
}

/// One channel of a run.
#[derive(Debug, Clone)]
pub struct ChannelView {
    /// The channel.
    pub channel: Channel,
    /// One sigma of the instrument, in the channel's unit.
    pub noise: f64,
    /// Measured, in the channel's unit.
    pub measured: Vec<f64>,
    /// Simulated by the initial model.
    pub before: Simulated,
    /// Simulated by the final model, if it differs.
    pub after: Option<Simulated>,
}
