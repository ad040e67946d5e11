//! One hitch of the closed loop, with its recent samples.

use hitch_plant::Model;
use hitch_quantities::{Inputs, ValidCalibration};

use super::orders::Orders;
use super::sensor_fault::Wiring;
use super::strip::{HitchView, Strip};
use crate::closed_loop::ClosedLoop;

/// Seed of the noise; both hitches have the same.
const SEED: u64 = 0x5eed_0001;

/// A hitch with its controller.
pub struct Hitch<'m> {
    closed_loop: ClosedLoop<'m>,
    wiring: Wiring,
    strip: Strip,
    load_kg: f64,
    oil_temperature_c: f64,
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
            strip: Strip::default(),
            load_kg,
            oil_temperature_c,
        }
    }

    /// Advances by `steps` milliseconds; returns the samples and the state at the end.
    pub fn advance(&mut self, orders: &Orders, steps: u32) -> HitchView {
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
            if self.strip.follow(&sample) {
                samples.push(sample);
            }
        }
        self.strip.view(&samples)
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
}
