//! What the page shows of one hitch: samples for the strip charts, state, faults, and figures of the last move.

use hitch_quantities::Outputs;
use hitch_quantities::units::MilliAmp;
use serde_json::{Value, json};

use super::figures::Moves;
use super::words;
use crate::closed_loop::Sample;

/// Distance of the samples of an answer, ms.
const SAMPLE_MS: u64 = 10;

/// The state of a hitch, and its moves.
#[derive(Debug, Default)]
pub struct Strip {
    moves: Moves,
    outputs: Outputs,
}

impl Strip {
    /// Includes a sample; whether it belongs into the strip charts.
    pub fn follow(&mut self, sample: &Sample) -> bool {
        self.moves.follow(sample);
        self.outputs = sample.outputs;
        ((sample.time_s * 1e3).round() as u64).is_multiple_of(SAMPLE_MS)
    }

    /// Samples and the present state.
    pub fn view(&self, samples: &[Sample]) -> Value {
        let each = |value: fn(&Sample) -> Option<f64>| -> Vec<Option<f64>> {
            samples.iter().map(value).collect()
        };
        let outputs = &self.outputs;
        json!({
            "time_s": each(|sample| Some(sample.time_s)),
            "angle_deg": each(|sample| Some(sample.angle_deg)),
            "shown_deg": each(|sample| sample.inputs.rocker_angle.map(|angle| f64::from(angle.0) * 1e-3)),
            "lift_a": each(|sample| ampere(sample.inputs.lift_current)),
            "lower_a": each(|sample| ampere(sample.inputs.lower_current)),
            "cylinder_bar": each(|sample| Some(sample.cylinder_pressure_bar)),
            "pump_bar": each(|sample| Some(sample.pump_pressure_bar)),
            "state": outputs.state.name(),
            "state_text": words::state(outputs.state),
            "fault": outputs.fault.map(|fault| fault.name()),
            "fault_text": outputs.fault.map(words::fault),
            "trip_text": outputs.trip.map(words::trip),
            "move": self.moves.last(),
        })
    }
}

fn ampere(current: Option<MilliAmp>) -> Option<f64> {
    current.map(|current| f64::from(current.0) * 1e-3)
}
