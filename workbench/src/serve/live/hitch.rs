//! One hitch of the closed loop, with its recent samples.

use hitch_plant::Model;
use hitch_quantities::units::MilliAmp;
use hitch_quantities::{Inputs, Outputs, ValidCalibration};
use serde_json::{Value, json};

use super::figures::Moves;
use super::orders::Orders;
use super::sensor_fault::Wiring;
use super::words;
use crate::closed_loop::{ClosedLoop, Sample};

/// Seed of the noise; both hitches have the same.
const SEED: u64 = 0x5eed_0001;
/// Distance of the samples of an answer, ms.
pub const SAMPLE_MS: u64 = 10;

/// A hitch with its controller.
pub struct Hitch<'m> {
    closed_loop: ClosedLoop<'m>,
    wiring: Wiring,
    moves: Moves,
    load_kg: f64,
    oil_temperature_c: f64,
    outputs: Outputs,
}

impl<'m> Hitch<'m> {
    /// A hitch at rest at an angle, degree, which follows the lever.
    pub fn new(
        plant: &'m Model,
        calibration: &ValidCalibration,
        orders: &Orders,
        angle_deg: f64,
    ) -> Self {
        let Orders {
            load_kg,
            oil_temperature_c,
            ..
        } = *orders;
        let mut closed_loop = ClosedLoop::new(
            plant,
            calibration,
            load_kg,
            oil_temperature_c,
            angle_deg,
            SEED,
        );
        closed_loop.pick_up();
        Self {
            closed_loop,
            wiring: Wiring::default(),
            moves: Moves::default(),
            load_kg,
            oil_temperature_c,
            outputs: Outputs::default(),
        }
    }

    /// Advances by `steps` milliseconds; returns the samples and the state at the end.
    pub fn advance(&mut self, orders: &Orders, steps: u32) -> Value {
        self.set_conditions(orders);
        let mut samples = Vec::new();
        for _ in 0..steps {
            let wiring = &mut self.wiring;
            let tell = |inputs: &mut Inputs| {
                orders.tell(inputs);
                wiring.apply(orders.fault, inputs);
            };
            let sample = self
                .closed_loop
                .step_with(orders.lever_deg, tell, |_, _| {});
            self.moves.follow(&sample);
            self.outputs = sample.outputs;
            if ((sample.time_s * 1e3).round() as u64).is_multiple_of(SAMPLE_MS) {
                samples.push(sample);
            }
        }
        self.view(&samples)
    }

    fn set_conditions(&mut self, orders: &Orders) {
        if self.load_kg != orders.load_kg {
            self.load_kg = orders.load_kg;
            self.closed_loop.set_load_kg(orders.load_kg);
        }
        if self.oil_temperature_c != orders.oil_temperature_c {
            self.oil_temperature_c = orders.oil_temperature_c;
            self.closed_loop
                .set_oil_temperature_c(orders.oil_temperature_c);
        }
    }

    fn view(&self, samples: &[Sample]) -> Value {
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
