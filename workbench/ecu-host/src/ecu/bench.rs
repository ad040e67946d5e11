//! The bench of the ECU: plant, coils, drivers, sensors and operator.

use hitch_ecu::link::Reply;
use hitch_ecu::{BoardScaling, Contacts};
use hitch_plant::Model;
use hitch_protocols::can::Frame;
use hitch_quantities::units::PerMille;

use super::converters::{Converters, SENSOR_SUPPLY_V, Signals};
use super::machine::{EcuMachine, MachineError};
use super::operator::Operator;
use hitch_closed_loop::{DrivenPlant, SUPPLY_V};

/// True state and signals of one millisecond.
#[derive(Debug, Clone, Copy)]
pub struct Moment {
    /// Time since the start of the plant, ms.
    pub time_ms: u64,
    /// The measured quantities.
    pub signals: Signals,
    /// The ECU's inputs.
    pub contacts: Contacts,
    /// The ECU's outputs.
    pub reply: Reply,
}

/// The bench.
pub struct Bench<'m> {
    plant: DrivenPlant<'m>,
    converters: Converters,
    time_ms: u64,
    /// Level of the enable line.
    enabled: bool,
    /// The operator, who takes commands between milliseconds.
    pub operator: Operator,
}

impl<'m> Bench<'m> {
    /// A hitch at rest at `start_angle_deg`, with the lever slightly below; `seed` determines the noise.
    pub fn new(
        model: &'m Model,
        load_kg: f64,
        oil_temperature_c: f64,
        start_angle_deg: f64,
        seed: u64,
    ) -> Self {
        Self {
            plant: DrivenPlant::at_rest(model, load_kg, oil_temperature_c, start_angle_deg),
            converters: Converters::new(model.constants().sensor_noise.clone(), seed),
            time_ms: 0,
            enabled: false,
            operator: Operator::with_lever_at(start_angle_deg - 5.0),
        }
    }

    /// Rocker angle, degree.
    pub fn angle_deg(&self) -> f64 {
        self.plant.angle_deg()
    }

    /// Changes the load of the hitch, kg.
    pub fn set_load_kg(&mut self, load_kg: f64) {
        self.plant.set_load_kg(load_kg);
    }

    /// Changes the oil temperature, C.
    pub fn set_oil_temperature_c(&mut self, oil_temperature_c: f64) {
        self.plant.set_oil_temperature_c(oil_temperature_c);
    }

    /// One millisecond of hitch and ECU.
    ///
    /// # Errors
    /// If the machine has ended.
    pub fn tick(
        &mut self,
        machine: &mut impl EcuMachine,
        heard: &[Frame],
        said: &mut Vec<Frame>,
    ) -> Result<Moment, MachineError> {
        self.tick_with(machine, heard, said, |_| {})
    }

    /// One millisecond in which `tamper` can modify the ECU's inputs: faults of wiring and sensors.
    ///
    /// # Errors
    /// If the machine has ended.
    pub fn tick_with(
        &mut self,
        machine: &mut impl EcuMachine,
        heard: &[Frame],
        said: &mut Vec<Frame>,
        tamper: impl FnOnce(&mut Contacts),
    ) -> Result<Moment, MachineError> {
        self.operator.tick();
        let signals = self.signals();
        let mut contacts = Contacts {
            samples: self.converters.convert(&signals),
            panel: self.operator.panel,
            clock_us: (self.time_ms * 1_000) as u32,
            enable_feedback: Some(self.enabled),
            clock_ratio: Some(PerMille(1_000)),
        };
        tamper(&mut contacts);
        let reply = machine.tick(&contacts, heard, said)?;
        self.move_on(&reply);
        Ok(Moment {
            time_ms: self.time_ms,
            signals,
            contacts,
            reply,
        })
    }

    /// One millisecond without ECU: the coils are currentless.
    pub fn tick_without_power(&mut self) {
        self.move_on(&Reply::default());
    }

    fn signals(&self) -> Signals {
        let (truth, currents) = (self.plant.reading(), self.plant.currents());
        Signals {
            rocker_angle_deg: truth.rocker_angle_deg,
            lever_deg: self.operator.lever_deg,
            upper_limit_deg: self.operator.upper_limit_deg,
            lowering_dial: self.operator.lowering_dial,
            lift_current_a: currents.lift_a,
            lower_current_a: currents.lower_a,
            supply_v: SUPPLY_V,
            sensor_supply_v: SENSOR_SUPPLY_V,
            reference: 1.0,
            cylinder_pressure_bar: truth.cylinder_pressure_bar,
            pump_pressure_bar: truth.pump_pressure_bar,
        }
    }

    fn move_on(&mut self, reply: &Reply) {
        // The drivers are off without the enable signal.
        let share = |compare: u16| {
            if reply.enable {
                f64::from(compare) / f64::from(BoardScaling::NOMINAL.pwm_steps)
            } else {
                0.0
            }
        };
        self.plant
            .step([reply.lift, reply.lower].map(share), |_| {});
        self.enabled = reply.enable;
        self.time_ms += 1;
    }
}
