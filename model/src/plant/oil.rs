//! The oil: SAE 30.

/// Hydraulic oil (paper: SAE 30, 877.3 kg/m3).
#[derive(Debug, Clone, PartialEq)]
pub struct Oil {
    /// Density, kg/m3.
    pub density_kg_m3: f64,
    /// Bulk modulus, Pa; used by the dynamic plant.
    pub bulk_modulus_pa: f64,
}
