//! What a run has: what the valve block is connected to, and the state of piston and oil.

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
    /// How far the bristles of friction that remembers are bent, m; nothing without any.
    pub bristles_m: f64,
    /// How far a hose's creeping wall is behind the pressure, Pa; the dynamic plant only, nothing without any.
    pub wall_behind_pa: f64,
    /// Pump pressure that a lagging compensator has got to, Pa; the idle one without a lag.
    pub compensator_pa: f64,
    /// Share of what it lacks that it catches up within a step of the quasi-static plant; nothing between steps.
    pub catching_up: f64,
}

impl MechanicalState {
    pub(crate) fn is_finite(&self) -> bool {
        [
            self.piston_m,
            self.speed_m_s,
            self.pressure_pa,
            self.void_m3,
            self.bristles_m,
            self.wall_behind_pa,
            self.compensator_pa,
        ]
        .iter()
        .all(|value| value.is_finite())
    }
}
