//! The single-acting lift cylinders.

/// Single-acting cylinder, or several alike in parallel (paper, Tables 1 and 4: one, bore 76 mm, stroke 158 mm).
#[derive(Debug, Clone, PartialEq)]
pub struct Cylinder {
    /// Number of cylinders in parallel.
    pub count: u8,
    /// Bore of each, m.
    pub bore_m: f64,
    /// Stroke, m.
    pub stroke_m: f64,
    /// Volume of lines and cylinders with the pistons fully retracted, m3.
    pub dead_volume_m3: f64,
    /// Viscous friction at all pistons, N s/m; used by the dynamic plant.
    pub viscous_friction_n_s_m: f64,
}

impl Cylinder {
    /// Area of all pistons, m2.
    #[inline]
    #[must_use]
    pub fn area_m2(&self) -> f64 {
        f64::from(self.count) * std::f64::consts::FRAC_PI_4 * self.bore_m * self.bore_m
    }

    /// Oil volume at piston travel `piston_m`, m3.
    #[inline]
    #[must_use]
    pub fn volume_m3(&self, piston_m: f64) -> f64 {
        self.dead_volume_m3 + self.area_m2() * piston_m
    }

    /// Whether an end stop carries the driving force on a piston at `piston_m` with speed `speed_m_s` and acceleration
    /// `acceleration_m_s2`.
    #[inline]
    #[must_use]
    pub fn stops(&self, piston_m: f64, speed_m_s: f64, acceleration_m_s2: f64) -> bool {
        let inwards = speed_m_s <= 0.0 && acceleration_m_s2 <= 0.0;
        let outwards = speed_m_s >= 0.0 && acceleration_m_s2 >= 0.0;
        (piston_m <= 0.0 && inwards) || (piston_m >= self.stroke_m && outwards)
    }
}
