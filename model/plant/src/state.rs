//! The rig of a run, and the state of piston and oil.

/// A hitch with a load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HitchRig {
    /// Load at the hitch point, kg, without the dead weight of the links.
    pub load_kg: f64,
    /// Rocker angle at the start as shown by its sensor, rad.
    pub start_angle_rad: f64,
}

/// The equipment that the valve block is connected to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rig {
    /// Cylinder, linkage and load.
    Hitch(HitchRig),
    /// A flow bench: no cylinder, the port at a constant pressure, Pa.
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
    /// Void under the piston after the oil column has torn, m3; dynamic plant only.
    pub void_m3: f64,
    /// Deflection of the bristles of friction with state, m; zero without any.
    pub bristles_m: f64,
    /// Lag of a hose's creeping wall behind the pressure, Pa; dynamic plant only, zero without any.
    pub wall_behind_pa: f64,
    /// Present pump pressure of a lagging compensator, Pa; the idle one without a lag.
    pub compensator_pa: f64,
    /// Share of its remaining deviation that it makes up within a step of the quasi-static plant; zero between steps.
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
