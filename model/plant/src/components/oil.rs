//! The oil: SAE 30.

/// Hydraulic oil (paper: SAE 30, 877.3 kg/m3).
#[derive(Debug, Clone, PartialEq)]
pub struct Oil {
    /// Density, kg/m3.
    pub density_kg_m3: f64,
    /// Bulk modulus, Pa; used by the dynamic plant.
    pub bulk_modulus_pa: f64,
}

/// Kinematic viscosity of SAE 30, m2/s, at a temperature, degree Celsius: Walther's equation through 95 mm2/s at 40 C.
#[must_use]
pub fn viscosity_m2_s(temperature_c: f64) -> f64 {
    let kelvin = (temperature_c + 273.15).max(200.0);
    let mm2_s = 10_f64.powf(10_f64.powf(9.1898 - 3.5632 * kelvin.log10())) - 0.7;
    mm2_s * 1e-6
}
