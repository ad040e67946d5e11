//! A hitch of the second rig with coil currents set each millisecond, for a controller.

use super::angle_sensor::AngleSensor;
use super::current_path::CurrentPath;
use super::data_sheet::BAR;
use super::hydraulics::{Circuit, Spools};
use super::linkage;
use super::mechanics::{Machine, Motion};
use super::physics::Physics;

/// Integration steps in a millisecond.
const PIECES: u32 = 2;
const PIECE_S: f64 = 1e-3 / PIECES as f64;

/// Load, oil and lag of one hitch.
#[derive(Debug, Clone, Copy)]
pub struct Conditions {
    /// Load at the hitch point, kg.
    pub load_kg: f64,
    /// Oil temperature, degC.
    pub oil_temperature_c: f64,
    /// First-order lag of both spools, s; further lag is in the physics.
    pub spool_lag_s: f64,
}

/// A hitch in motion.
#[derive(Debug, Clone)]
pub struct DrivenHitch<'a> {
    circuit: Circuit<'a>,
    paths: [CurrentPath; 2],
    spools: Spools,
    machine: Machine<'a>,
    motion: Motion,
    sensor: AngleSensor<'a>,
    pressure_offset_bar: f64,
}

impl<'a> DrivenHitch<'a> {
    /// A hitch at rest at a rocker angle, degree, without current.
    #[must_use]
    pub fn new(physics: &'a Physics, conditions: Conditions, rocker_deg: f64) -> Self {
        let mut circuit = Circuit::new(physics, conditions.oil_temperature_c);
        let machine = Machine::new(physics, conditions.load_kg, circuit.fluidity());
        let motion = machine.at_rest(linkage::travel_m(rocker_deg));
        circuit.set_slow(0.0, motion.travel_m);
        Self {
            circuit,
            paths: CurrentPath::both(physics, conditions.spool_lag_s),
            spools: Spools::default(),
            machine,
            motion,
            sensor: AngleSensor::new(&physics.sensors, motion.travel_m),
            pressure_offset_bar: physics.sensors.pressure_offset_pa / BAR,
        }
    }

    /// One millisecond under the currents of lift and lowering coil, A.
    pub fn step(&mut self, [lift_a, lower_a]: [f64; 2]) {
        for _ in 0..PIECES {
            let from = self.spools;
            self.spools = Spools {
                lift_a: self.paths[0].advance(lift_a, PIECE_S),
                lower_a: self.paths[1].advance(lower_a, PIECE_S),
            };
            self.circuit.set_slow(0.0, self.motion.travel_m);
            self.circuit
                .advance(self.spools, self.motion.pressure_pa, PIECE_S);
            let spools = [from, self.spools];
            self.machine
                .step_dynamic(&self.circuit, &mut self.motion, spools, PIECE_S);
            self.sensor.advance(self.motion.travel_m, PIECE_S);
        }
    }

    /// Rocker angle as it is, degree.
    #[must_use]
    pub fn rocker_deg(&self) -> f64 {
        linkage::at(self.motion.travel_m).rocker_deg
    }

    /// Rocker angle as the sensor shows it, without noise, degree.
    #[must_use]
    pub fn shown_deg(&self) -> f64 {
        self.sensor.shown_deg()
    }

    /// What the sensor shows of a hitch that rests at an angle, without noise, degree.
    #[must_use]
    pub fn shown_at_rest_deg(&self, rocker_deg: f64) -> f64 {
        self.sensor.shown_at_rest_deg(rocker_deg)
    }

    /// Cylinder pressure as it is, bar.
    #[must_use]
    pub fn cylinder_bar(&self) -> f64 {
        self.motion.pressure_pa / BAR
    }

    /// Cylinder and pump pressure as their sensors show them, without noise, bar.
    #[must_use]
    pub fn shown_bar(&self) -> [f64; 2] {
        let flows = self.circuit.flows(self.spools, self.motion.pressure_pa);
        [
            self.cylinder_bar() + self.pressure_offset_bar,
            flows.pump_pressure_pa / BAR,
        ]
    }
}
