//! One hitch of the closed loop, with its recent samples.

use hitch_plant::Model;
use hitch_quantities::Inputs;

use super::machine::Calibrations;
use super::orders::Orders;
use super::sensor_fault::Wiring;
use super::strip::{HitchView, Strip};
use super::worked::WorkedHitch;
use crate::closed_loop::{ClosedLoop, Sample};
use crate::field::Start;

/// Seed of the noise; both hitches have the same.
const SEED: u64 = 0x5eed_0001;

/// What is behind the hitch.
enum Drive<'m> {
    /// A load alone.
    Load(Box<ClosedLoop<'m>>),
    /// An implement in the soil.
    Field(Box<WorkedHitch<'m>>),
}

/// A hitch with its controller.
pub struct Hitch<'m> {
    drive: Drive<'m>,
    wiring: Wiring,
    strip: Strip,
    load_kg: f64,
    oil_temperature_c: f64,
}

impl<'m> Hitch<'m> {
    /// A hitch at rest at an angle, degree, which follows the lever; on a field if the orders have one and the machine can
    /// work on it.
    pub fn new(
        plant: &'m Model,
        calibrations: Calibrations<'_>,
        orders: &Orders,
        angle_deg: f64,
    ) -> Self {
        let Orders {
            load_kg,
            oil_temperature_c,
            ..
        } = *orders;
        let drive = match (orders.field, calibrations.working) {
            (Some(field), Some(working)) => {
                let start = Start {
                    angle_deg,
                    oil_temperature_c,
                    seed: SEED,
                };
                Drive::Field(Box::new(WorkedHitch::new(plant, working, field, start)))
            }
            _ => {
                let mut closed_loop = ClosedLoop::new(
                    plant,
                    calibrations.plain,
                    load_kg,
                    oil_temperature_c,
                    angle_deg,
                    SEED,
                );
                closed_loop.pick_up();
                Drive::Load(Box::new(closed_loop))
            }
        };
        Self {
            drive,
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
            let sample = self.step(orders);
            if Strip::shows(&sample) {
                samples.push(sample);
            }
        }
        let field = match &mut self.drive {
            Drive::Load(_) => None,
            Drive::Field(worked) => Some(worked.view()),
        };
        HitchView {
            field,
            ..self.strip.view(&samples)
        }
    }

    fn step(&mut self, orders: &Orders) -> Sample {
        let wiring = &mut self.wiring;
        let tell = |inputs: &mut Inputs| {
            orders.tell(inputs);
            wiring.apply(orders.fault, inputs);
        };
        let sample = match &mut self.drive {
            Drive::Load(closed_loop) => closed_loop.step_with(orders.lever_deg, tell, |_, _| {}),
            Drive::Field(worked) => worked.step(orders.lever_deg, tell, Strip::shows),
        };
        self.strip.follow(&sample);
        sample
    }

    fn set_conditions(&mut self, orders: &Orders) {
        if self.load_kg != orders.load_kg {
            self.load_kg = orders.load_kg;
            if let Drive::Load(closed_loop) = &mut self.drive {
                closed_loop.set_load_kg(orders.load_kg);
            }
        }
        if self.oil_temperature_c != orders.oil_temperature_c {
            let oil_temperature_c = orders.oil_temperature_c;
            self.oil_temperature_c = oil_temperature_c;
            match &mut self.drive {
                Drive::Load(closed_loop) => closed_loop.set_oil_temperature_c(oil_temperature_c),
                Drive::Field(worked) => worked.set_oil_temperature_c(oil_temperature_c),
            }
        }
        if let Drive::Field(worked) = &mut self.drive {
            worked.order(orders.field);
        }
    }
}
