//! The plant: one file a component, and the two ways to set it in motion.
//!
//! ```text
//!                 relief                       load
//!                   |                           |
//!   pump ---+---- PC valve -> tank           linkage
//!           |                                   |
//!           +-- lift valve -- check valve --+-- cylinder
//!                                           |
//!                                  lowering valve -> return line -> tank
//! ```
//!
//! [`circuit`] solves the hydraulics at one instant; [`steady`] and [`dynamic`] move the piston. Effects act at
//! [`sites`].

pub mod check_valve;
pub mod circuit;
pub mod compensator;
pub mod cylinder;
pub mod dynamic;
pub mod forces;
pub mod lag;
pub mod linkage;
pub mod load;
pub mod oil;
pub mod orifice_valve;
pub mod pump;
pub mod relief_valve;
pub mod root;
pub mod signals;
pub mod sites;
pub mod steady;
pub mod valve_curve;

pub use check_valve::CheckValve;
pub use compensator::Compensator;
pub use cylinder::Cylinder;
pub use linkage::{Linkage, LinkageDimensions, LinkageError, Posture};
pub use load::Masses;
pub use oil::Oil;
pub use orifice_valve::OrificeValve;
pub use pump::Pump;
pub use relief_valve::ReliefValve;
pub use sites::{Currents, Valve};
pub use valve_curve::{ValveCurve, ValveCurveError};

use crate::campaign::Channel;
use crate::model::{Dynamics, Model};
use crate::units;
use circuit::{Circuit, Flows, Openings};
use forces::Forces;
use lag::Lag;
use sites::{RunConditions, Sites};

/// A hitch with a load on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HitchRig {
    /// Load at the hitch point, kg, without the dead weight of the links.
    pub load_kg: f64,
    /// Rocker angle at the start as its sensor shows it, rad.
    pub start_angle_rad: f64,
}

/// What the valve block is connected to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rig {
    /// Cylinder, linkage and load.
    Hitch(HitchRig),
    /// A flow bench: no cylinder, the port held at a pressure, Pa.
    Flow {
        /// Port pressure, Pa.
        port_pressure_pa: f64,
    },
}

/// State of the piston and of the oil under it.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct MechanicalState {
    /// Piston travel, m; zero with the hitch fully down.
    pub piston_m: f64,
    /// Piston speed, m/s, positive upwards.
    pub speed_m_s: f64,
    /// Cylinder pressure, Pa.
    pub pressure_pa: f64,
    /// Void under the piston where the oil column has torn, m3; the dynamic plant only.
    pub void_m3: f64,
}

/// What the instruments show, in their units.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Reading {
    /// Pump pressure, bar.
    pub pump_pressure_bar: f64,
    /// Cylinder pressure, bar.
    pub cylinder_pressure_bar: f64,
    /// Flow into the cylinder, l/min.
    pub flow_lpm: f64,
    /// Rocker angle, degree; on a flow bench not a number.
    pub rocker_angle_deg: f64,
}

/// The plant in motion.
pub struct Plant<'m> {
    model: &'m Model,
    rig: Rig,
    sites: Sites,
    spools: [Lag; 2],
    openings: Openings,
    state: MechanicalState,
    lowest_m: f64,
    flows: Flows,
    input: Currents,
    reading: Reading,
}

impl<'m> Plant<'m> {
    /// A plant at rest under the currents `at_rest`, with the model's effects attached.
    #[must_use]
    pub fn new(model: &'m Model, rig: Rig, oil_temperature_c: f64, at_rest: Currents) -> Self {
        let mut sites = Sites::default();
        for effect in &model.effects {
            let conditions = RunConditions {
                oil_temperature_c,
                constants: model.constants(),
                linkage: model.linkage(),
            };
            effect.attach(conditions, &mut sites);
        }
        let effective = sites
            .currents
            .iter_mut()
            .fold(at_rest, |currents, stage| stage.rest(currents));
        let constants = model.constants();
        let lag_s = match constants.dynamics {
            Dynamics::Steady => 0.0,
            Dynamics::Dynamic => constants.spool_time_constant_s,
        };
        let spools = [effective.lift_a, effective.lower_a].map(|a| Lag::at_rest(lag_s, a));
        let mut plant = Self {
            model,
            rig,
            sites,
            spools,
            openings: Openings::default(),
            state: MechanicalState::default(),
            lowest_m: 0.0,
            flows: Flows::default(),
            input: at_rest,
            reading: Reading::default(),
        };
        plant.openings = plant
            .circuit()
            .openings(effective.lift_a, effective.lower_a);
        if let Rig::Hitch(rig) = rig {
            plant.lowest_m = plant.forces(&rig).lowest_m();
        }
        plant.state = plant.state_at_rest();
        plant.refresh();
        let mut reading = plant.truth();
        for sensor in &mut plant.sites.sensors {
            sensor.rest(&mut reading);
        }
        plant.reading = reading;
        plant
    }

    /// Goes on by `dt_s` while the coil currents run linearly to `currents`.
    pub fn step(&mut self, currents: Currents, dt_s: f64) {
        let longest_s = match self.model.constants().dynamics {
            Dynamics::Steady => steady::LONGEST_STEP_S,
            Dynamics::Dynamic => dynamic::LONGEST_STEP_S,
        };
        // A hair of slack: 0.02 s read from a log as a difference must not become one piece more.
        let pieces = (dt_s / longest_s - 1e-6).ceil().max(1.0) as usize;
        let from = self.input;
        for piece in 1..=pieces {
            let share = piece as f64 / pieces as f64;
            let currents = Currents {
                lift_a: from.lift_a + (currents.lift_a - from.lift_a) * share,
                lower_a: from.lower_a + (currents.lower_a - from.lower_a) * share,
            };
            self.integrate(currents, dt_s / pieces as f64);
        }
        if !matches!(
            (self.rig, self.model.constants().dynamics),
            (Rig::Hitch(_), Dynamics::Steady)
        ) {
            self.refresh();
        }
        let mut reading = self.truth();
        for sensor in &mut self.sites.sensors {
            sensor.advance(&mut reading, dt_s);
        }
        self.reading = reading;
    }

    /// What the instruments show now.
    #[must_use]
    pub fn reading(&self) -> Reading {
        self.reading
    }

    /// Piston travel, speed and cylinder pressure now.
    #[must_use]
    pub fn state(&self) -> MechanicalState {
        self.state
    }

    /// Flows and pump pressure now.
    #[must_use]
    pub fn flows(&self) -> Flows {
        self.flows
    }

    /// Rocker angle, rad; on a flow bench not a number.
    #[must_use]
    pub fn rocker_angle_rad(&self) -> f64 {
        match self.rig {
            Rig::Hitch(_) => {
                self.model
                    .linkage()
                    .at(self.state.piston_m)
                    .rocker_angle_rad
            }
            Rig::Flow { .. } => f64::NAN,
        }
    }

    fn circuit(&self) -> Circuit<'_> {
        Circuit {
            constants: self.model.constants(),
            sites: &self.sites,
        }
    }

    fn forces<'a>(&'a self, rig: &'a HitchRig) -> Forces<'a> {
        Forces {
            model: self.model,
            sites: &self.sites,
            rig,
        }
    }

    /// One integration step.
    fn integrate(&mut self, currents: Currents, dt_s: f64) {
        let from = self.input;
        self.input = currents;
        match (self.rig, self.model.constants().dynamics) {
            (Rig::Flow { .. }, _) => {
                self.open(currents, dt_s);
            }
            (Rig::Hitch(rig), Dynamics::Steady) => {
                let end = self.open(currents, dt_s);
                let before = steady::Before {
                    speed_m_s: self.state.speed_m_s,
                    dt_s,
                };
                let (forces, circuit) = (self.forces(&rig), self.circuit());
                self.state.piston_m =
                    steady::step(&forces, &circuit, self.state, end, self.lowest_m, dt_s);
                self.balance(&rig, Some(before));
            }
            (Rig::Hitch(rig), Dynamics::Dynamic) => {
                let middle = Currents {
                    lift_a: 0.5 * (from.lift_a + currents.lift_a),
                    lower_a: 0.5 * (from.lower_a + currents.lower_a),
                };
                let start = self.openings;
                let half = self.open(middle, 0.5 * dt_s);
                let end = self.open(currents, 0.5 * dt_s);
                let openings = [start, half, end];
                let (forces, circuit) = (self.forces(&rig), self.circuit());
                self.state = dynamic::step(&forces, &circuit, self.state, openings, dt_s);
            }
        }
    }

    /// Takes the currents through effects and spools to openings.
    fn open(&mut self, currents: Currents, dt_s: f64) -> Openings {
        let effective = self
            .sites
            .currents
            .iter_mut()
            .fold(currents, |currents, stage| stage.advance(currents, dt_s));
        let lift_a = self.spools[0].advance(effective.lift_a, dt_s);
        let lower_a = self.spools[1].advance(effective.lower_a, dt_s);
        self.openings = self.circuit().openings(lift_a, lower_a);
        self.openings
    }

    fn state_at_rest(&self) -> MechanicalState {
        match self.rig {
            Rig::Flow { port_pressure_pa } => MechanicalState {
                pressure_pa: port_pressure_pa,
                ..MechanicalState::default()
            },
            Rig::Hitch(rig) => {
                let constants = self.model.constants();
                let angle_deg = self
                    .sites
                    .sensors
                    .iter()
                    .rev()
                    .fold(rig.start_angle_rad.to_degrees(), |shown_deg, sensor| {
                        sensor.angle_behind_deg(shown_deg)
                    });
                let piston_m = self.model.linkage().piston_m(angle_deg.to_radians());
                let piston_m = piston_m.max(self.lowest_m);
                let forces = self.forces(&rig);
                let held_n = forces.weight_n(piston_m) - forces.ground_n(piston_m, 0.0);
                MechanicalState {
                    piston_m,
                    speed_m_s: 0.0,
                    pressure_pa: held_n.max(0.0) / constants.cylinder.area_m2(),
                    void_m3: 0.0,
                }
            }
        }
    }

    /// Brings the quasi-static speed, pressure and flows up to the present openings and travel.
    fn balance(&mut self, rig: &HitchRig, before: Option<steady::Before>) {
        let (forces, circuit) = (self.forces(rig), self.circuit());
        let balance = steady::balance(
            &forces,
            &circuit,
            self.openings,
            self.state.piston_m,
            before,
        );
        self.state.speed_m_s = balance.speed_m_s;
        self.state.pressure_pa = balance.pressure_pa;
        self.flows = balance.flows;
    }

    /// Brings the flows up to the present state.
    fn refresh(&mut self) {
        match (self.rig, self.model.constants().dynamics) {
            (Rig::Hitch(rig), Dynamics::Steady) => self.balance(&rig, None),
            _ => self.flows = self.circuit().solve(self.openings, self.state.pressure_pa),
        }
    }

    /// The quantities themselves, in the instruments' units.
    fn truth(&self) -> Reading {
        Reading {
            pump_pressure_bar: units::bar_from_pa(self.flows.pump_pressure_pa),
            cylinder_pressure_bar: units::bar_from_pa(self.state.pressure_pa),
            flow_lpm: units::lpm_from_m3_s(self.flows.metered_m3_s()),
            rocker_angle_deg: self.rocker_angle_rad().to_degrees(),
        }
    }
}

impl Reading {
    /// The reading of one channel, in the channel's unit.
    #[must_use]
    pub fn channel(&self, channel: Channel) -> f64 {
        match channel {
            Channel::PumpPressure => self.pump_pressure_bar,
            Channel::CylinderPressure => self.cylinder_pressure_bar,
            Channel::Flow => self.flow_lpm,
            Channel::RockerAngle => self.rocker_angle_deg,
        }
    }
}
