//! The single-acting lift cylinder.

/// Single-acting cylinder (paper, Tables 1 and 4: bore 76 mm, stroke 158 mm).
#[derive(Debug, Clone, PartialEq)]
pub struct Cylinder {
    /// Bore, m.
    pub bore_m: f64,
    /// Stroke, m.
    pub stroke_m: f64,
    /// Volume of line and cylinder with the piston fully in, m3.
    pub dead_volume_m3: f64,
    /// Viscous friction at the piston, N s/m; used by the dynamic plant.
    pub viscous_friction_n_s_m: f64,
    /// Stiffness of the mechanical end stops, N/m; used by the dynamic plant.
    pub stop_stiffness_n_m: f64,
    /// Damping of the mechanical end stops while in contact, N s/m; used by the dynamic plant.
    pub stop_damping_n_s_m: f64,
}

impl Cylinder {
    /// Piston area, m2.
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        std::f64::consts::FRAC_PI_4 * self.bore_m * self.bore_m
    }

    /// Oil volume at piston travel `piston_m`, m3.
    #[must_use]
    pub fn volume_m3(&self, piston_m: f64) -> f64 {
        self.dead_volume_m3 + self.area_m2() * piston_m
    }

    /// Force of the end stops on the piston, N, positive outwards: a spring and damper that can only push.
    #[must_use]
    pub fn stop_force_n(&self, piston_m: f64, speed_m_s: f64) -> f64 {
        if piston_m < 0.0 {
            (-self.stop_stiffness_n_m * piston_m - self.stop_damping_n_s_m * speed_m_s).max(0.0)
        } else if piston_m > self.stroke_m {
            (-self.stop_stiffness_n_m * (piston_m - self.stroke_m)
                - self.stop_damping_n_s_m * speed_m_s)
                .min(0.0)
        } else {
            0.0
        }
    }
}
