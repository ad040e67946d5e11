//! What the page shows of one hitch: samples for the strip charts, state, faults, and figures of the last move.

use hitch_quantities::Outputs;
use hitch_quantities::units::MilliAmp;
use schemars::JsonSchema;
use serde::Serialize;

use super::field_view::FieldView;
use super::figures::{MoveFigures, Moves};
use super::words;
use crate::closed_loop::Sample;

/// Distance of the samples of an answer, ms.
const SAMPLE_MS: u64 = 10;

/// Samples of a hitch since the last answer, and its present state; `null` for a sample that is missing.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct HitchView {
    /// Times of the samples, s.
    pub time_s: Vec<f64>,
    /// Rocker angle, degree.
    pub angle_deg: Vec<Option<f64>>,
    /// Rocker angle as its sensor shows it, degree.
    pub shown_deg: Vec<Option<f64>>,
    /// Current of the lift valve, A.
    pub lift_a: Vec<Option<f64>>,
    /// Current of the lowering valve, A.
    pub lower_a: Vec<Option<f64>>,
    /// Cylinder pressure, bar.
    pub cylinder_bar: Vec<Option<f64>>,
    /// Pump pressure, bar.
    pub pump_bar: Vec<Option<f64>>,
    /// State in short.
    pub state: String,
    /// State as sentences.
    pub state_text: String,
    /// Fault in short.
    pub fault: Option<String>,
    /// Fault in words.
    pub fault_text: Option<String>,
    /// What the safety envelope found.
    pub trip_text: Option<&'static str>,
    /// Figures of the last move.
    #[serde(rename = "move")]
    pub last_move: Option<MoveFigures>,
    /// Tractor and field, of a hitch that works on one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<FieldView>,
}

/// The state of a hitch, and its moves.
#[derive(Debug, Default)]
pub struct Strip {
    moves: Moves,
    outputs: Outputs,
}

impl Strip {
    /// Whether a sample belongs into the strip charts.
    pub fn shows(sample: &Sample) -> bool {
        ((sample.time_s * 1e3).round() as u64).is_multiple_of(SAMPLE_MS)
    }

    /// Includes a sample.
    pub fn follow(&mut self, sample: &Sample) {
        self.moves.follow(sample);
        self.outputs = sample.outputs;
    }

    /// Samples and the present state.
    pub fn view(&self, samples: &[Sample]) -> HitchView {
        let each = |value: fn(&Sample) -> Option<f64>| -> Vec<Option<f64>> {
            samples.iter().map(value).collect()
        };
        let outputs = &self.outputs;
        HitchView {
            time_s: samples.iter().map(|sample| sample.time_s).collect(),
            angle_deg: each(|sample| Some(sample.angle_deg)),
            shown_deg: each(|sample| {
                let angle = sample.inputs.rocker_angle;
                angle.map(|angle| f64::from(angle.0) * 1e-3)
            }),
            lift_a: each(|sample| ampere(sample.inputs.lift_current)),
            lower_a: each(|sample| ampere(sample.inputs.lower_current)),
            cylinder_bar: each(|sample| Some(sample.cylinder_pressure_bar)),
            pump_bar: each(|sample| Some(sample.pump_pressure_bar)),
            state: outputs.state.name().to_owned(),
            state_text: words::state(outputs.state).to_owned(),
            fault: outputs.fault.map(|fault| fault.name().to_owned()),
            fault_text: outputs.fault.map(|fault| words::fault(fault).to_owned()),
            trip_text: outputs.trip.map(words::trip),
            last_move: self.moves.last(),
            field: None,
        }
    }
}

fn ampere(current: Option<MilliAmp>) -> Option<f64> {
    current.map(|current| f64::from(current.0) * 1e-3)
}
