//! A run as the report shows it.

use hitch_plant::Channel;

use crate::web::plot::SimulatedChannel;

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

/// One channel of a run.
#[derive(Debug, Clone)]
pub struct ChannelView {
    /// The channel.
    pub channel: Channel,
    /// One sigma of the instrument, in the channel's unit.
    pub noise: f64,
    /// Measured, in the channel's unit.
    pub measured: Vec<f64>,
    /// Simulated by the initial model; residuals are NaN where not compared.
    pub before: SimulatedChannel<Vec<f64>>,
    /// Simulated by the final model, if it differs.
    pub after: Option<SimulatedChannel<Vec<f64>>>,
}
