//! One hitch with its controller, in steps of a millisecond.

use hitch_controller::Controller;
use hitch_plant::{Currents, Model};
use hitch_quantities::units::Duty;
use hitch_quantities::{Inputs, Outputs, ValidCalibration};

use super::driven_plant::{DrivenPlant, STEP_S};
use super::instruments::Instruments;

/// True state and signals of one millisecond.
#[derive(Debug, Clone, Copy)]
pub struct Sample {
    /// Time since the loop was closed, s.
    pub time_s: f64,
    /// Set point on the lever, degree.
    pub lever_deg: f64,
    /// Rocker angle without noise, degree.
    pub angle_deg: f64,
    /// Cylinder pressure without noise, bar.
    pub cylinder_pressure_bar: f64,
    /// Pump pressure without noise, bar.
    pub pump_pressure_bar: f64,
    /// The controller's inputs.
    pub inputs: Inputs,
    /// The controller's outputs.
    pub outputs: Outputs,
}

impl Sample {
    /// Current that the controller asks of the lift coil, A.
    #[must_use]
    pub fn lift_current_a(&self) -> f64 {
        f64::from(self.outputs.lift_current.0) * 1e-3
    }

    /// Current that the controller asks of the lowering coil, A.
    #[must_use]
    pub fn lower_current_a(&self) -> f64 {
        f64::from(self.outputs.lower_current.0) * 1e-3
    }
}

/// Plant, coils, instruments and controller.
pub struct ClosedLoop<'m> {
    plant: DrivenPlant<'m>,
    instruments: Instruments,
    controller: Controller,
    steps: u64,
}

impl<'m> ClosedLoop<'m> {
    /// A hitch at rest at `start_angle_deg`; its controller is in the state after power-up.
    #[must_use]
    pub fn new(
        model: &'m Model,
        calibration: &ValidCalibration,
        load_kg: f64,
        oil_temperature_c: f64,
        start_angle_deg: f64,
        seed: u64,
    ) -> Self {
        Self {
            plant: DrivenPlant::at_rest(model, load_kg, oil_temperature_c, start_angle_deg),
            instruments: Instruments::new(&model.constants().sensor_noise, seed, oil_temperature_c),
            controller: Controller::new(calibration.clone()),
            steps: 0,
        }
    }

    /// One millisecond with the lever at `lever_deg`.
    pub fn step(&mut self, lever_deg: f64) -> Sample {
        self.step_with(lever_deg, |_| {}, |_, _| {})
    }

    /// One millisecond in which `tell` can modify the controller's inputs (operator switches, sensor faults) and `wire`
    /// the coil voltages (faults of coils and drivers).
    pub fn step_with(
        &mut self,
        lever_deg: f64,
        tell: impl FnOnce(&mut Inputs),
        wire: impl FnOnce(&Outputs, &mut Currents),
    ) -> Sample {
        let truth = self.plant.reading();
        let mut inputs = self
            .instruments
            .read(&truth, self.plant.currents(), lever_deg);
        tell(&mut inputs);
        let outputs = self.controller.step(&inputs);
        let sample = Sample {
            time_s: self.steps as f64 * STEP_S,
            lever_deg,
            angle_deg: self.plant.angle_deg(),
            cylinder_pressure_bar: truth.cylinder_pressure_bar,
            pump_pressure_bar: truth.pump_pressure_bar,
            inputs,
            outputs,
        };
        let shares = [outputs.lift_duty, outputs.lower_duty].map(share);
        self.plant.step(shares, |currents| wire(&outputs, currents));
        self.steps += 1;
        sample
    }

    /// Changes the load of the hitch, kg, while it runs.
    pub fn set_load_kg(&mut self, load_kg: f64) {
        self.plant.set_load_kg(load_kg);
    }

    /// Changes the oil temperature, C, while it runs.
    pub fn set_oil_temperature_c(&mut self, oil_temperature_c: f64) {
        self.plant.set_oil_temperature_c(oil_temperature_c);
        self.instruments.set_oil_temperature_c(oil_temperature_c);
    }

    /// The controller.
    #[must_use]
    pub const fn controller(&self) -> &Controller {
        &self.controller
    }

    /// Moves the lever to the hitch position after power-up (lever capture), as an operator does, and leaves both at
    /// rest.
    pub fn pick_up(&mut self) {
        const AWAY_DEG: f64 = 2.0;
        let here_deg = self.plant.angle_deg();
        for _ in 0..100 {
            self.step(here_deg - AWAY_DEG);
        }
        for _ in 0..400 {
            self.step(here_deg);
        }
    }
}

fn share(duty: Duty) -> f64 {
    f64::from(duty.0) * 1e-5
}
