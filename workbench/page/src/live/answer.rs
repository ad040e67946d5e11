//! The answer to an advance of the closed loop.

use hitch_closed_loop::driven::HitchView;
use schemars::JsonSchema;
use serde::Serialize;

/// The hitches after an advance.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct LoopAnswer {
    /// Both hitches of the simulation, or the one of an ECU.
    pub loops: Vec<HitchView>,
    /// Simulated time over computing time, of a simulation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<f64>,
    /// Whether an emulated ECU is behind real time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub behind: Option<bool>,
    /// The connection to an ECU on the bus.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bus: Option<Connection>,
}

/// The connection to an ECU on the bus.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Connection {
    /// Whether the adapter is connected.
    pub connected: bool,
    /// Why there are no data; `null` if they arrive.
    pub problem: Option<String>,
    /// The connection in one sentence.
    pub text: String,
    /// Reported position, percent, 0 lowest; `null` if its sensor is bad.
    pub position_percent: Option<f64>,
}
