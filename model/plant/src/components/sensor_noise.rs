//! The noise of the sensors.

/// One sigma of the noise of the sensors. The plant has none; a closed loop measures with it.
#[derive(Debug, Clone, PartialEq)]
pub struct SensorNoise {
    /// Rocker angle, degree.
    pub rocker_angle_deg: f64,
    /// Cylinder pressure, bar.
    pub cylinder_pressure_bar: f64,
    /// Pump pressure, bar.
    pub pump_pressure_bar: f64,
    /// Measured current of a coil, A.
    pub current_a: f64,
}

impl Default for SensorNoise {
    /// Typical sensors of a tractor.
    fn default() -> Self {
        Self {
            rocker_angle_deg: 0.05,
            cylinder_pressure_bar: 0.10,
            pump_pressure_bar: 0.15,
            current_a: 0.003,
        }
    }
}
