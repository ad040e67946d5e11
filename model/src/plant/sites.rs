//! The places in the plant where a physical effect can act.
//!
//! An effect (see [`crate::effects`]) attaches closures or small stateful parts here; the plant calls them where the
//! physics has them. With nothing attached every sum is empty and the plant is the paper's.

use super::Reading;

/// Which of the two solenoid valves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Valve {
    /// The lift valve, pump to cylinder.
    Lift,
    /// The lowering valve, cylinder to tank.
    Lowering,
}

/// The two coil currents, A.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Currents {
    /// Lift solenoid, A.
    pub lift_a: f64,
    /// Lowering solenoid, A.
    pub lower_a: f64,
}

impl Currents {
    /// The same change to both currents.
    #[must_use]
    pub fn map(self, mut change: impl FnMut(Valve, f64) -> f64) -> Self {
        Self {
            lift_a: change(Valve::Lift, self.lift_a),
            lower_a: change(Valve::Lowering, self.lower_a),
        }
    }
}

/// A part between coil current and effective spool current; it may remember (hysteresis, lag).
pub trait CurrentStage: Send + Sync + std::fmt::Debug {
    /// Puts the part at rest under these currents and returns what it passes on.
    fn rest(&mut self, currents: Currents) -> Currents;
    /// Goes on by `dt_s` while the currents run linearly to `currents`; returns what it passes on.
    fn advance(&mut self, currents: Currents, dt_s: f64) -> Currents;
}

/// A part between a physical quantity and what its instrument shows; it may remember (lag).
pub trait SensorStage: Send + Sync + std::fmt::Debug {
    /// Puts the instrument at rest at this reading.
    fn rest(&mut self, reading: &mut Reading);
    /// Goes on by `dt_s` to `reading` and turns it into what is shown.
    fn advance(&mut self, reading: &mut Reading, dt_s: f64);
}

/// A force on the piston against its motion, N, from its speed, m/s.
pub type FrictionForce = Box<dyn Fn(f64) -> f64 + Send + Sync>;
/// A back pressure, Pa, from the flow through the lowering valve, m3/s.
pub type ReturnPressure = Box<dyn Fn(f64) -> f64 + Send + Sync>;
/// A flow out of the cylinder past the valves, m3/s, from the cylinder pressure, Pa.
pub type Leakage = Box<dyn Fn(f64) -> f64 + Send + Sync>;

/// What the active effects have attached to one plant.
pub struct Sites {
    /// Between coil current and effective spool current, in order.
    pub currents: Vec<Box<dyn CurrentStage>>,
    /// Factor on the lift valve's flow.
    pub lift_flow_factor: f64,
    /// Factor on the lowering valve's flow.
    pub lower_flow_factor: f64,
    /// Friction at the piston.
    pub friction: Vec<FrictionForce>,
    /// Pressure behind the lowering valve.
    pub return_pressure: Vec<ReturnPressure>,
    /// Leakage out of the cylinder.
    pub leakage: Vec<Leakage>,
    /// Instruments, in order.
    pub sensors: Vec<Box<dyn SensorStage>>,
}

impl Default for Sites {
    fn default() -> Self {
        Self {
            currents: Vec::new(),
            lift_flow_factor: 1.0,
            lower_flow_factor: 1.0,
            friction: Vec::new(),
            return_pressure: Vec::new(),
            leakage: Vec::new(),
            sensors: Vec::new(),
        }
    }
}

impl Sites {
    /// Sum of the friction forces, N, at a piston speed.
    #[must_use]
    pub fn friction_n(&self, speed_m_s: f64) -> f64 {
        self.friction.iter().map(|force| force(speed_m_s)).sum()
    }

    /// Sum of the back pressures, Pa, at a flow through the lowering valve.
    #[must_use]
    pub fn return_pressure_pa(&self, flow_m3_s: f64) -> f64 {
        self.return_pressure
            .iter()
            .map(|pressure| pressure(flow_m3_s))
            .sum()
    }

    /// Sum of the leakages, m3/s, at a cylinder pressure.
    #[must_use]
    pub fn leakage_m3_s(&self, cylinder_pressure_pa: f64) -> f64 {
        self.leakage
            .iter()
            .map(|leak| leak(cylinder_pressure_pa))
            .sum()
    }
}

/// What an effect may know of the run that it is attached to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RunConditions {
    /// Oil temperature, degree Celsius.
    pub oil_temperature_c: f64,
}
