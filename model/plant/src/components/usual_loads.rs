//! The loads that a machine usually carries.

/// Loads at the hitch point with which a controller is tried and tuned, kg; zero where the machine's circuit decides
/// ([`crate::Model::usual_loads_kg`]).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct UsualLoads {
    /// A light implement.
    pub light_kg: f64,
    /// The most common implement.
    pub usual_kg: f64,
    /// The heaviest implement.
    pub heavy_kg: f64,
}
