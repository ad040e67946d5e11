//! Nuisance parameters of a run, and the shift of its currents.

/// Nuisance parameters of a run: errors of the set-up, fitted with a prior.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Nuisance {
    /// Error of the weighed load, relative.
    pub load: f64,
}

/// Prior sigma of [`Nuisance::load`]: a load is weighed to about half a percent (docs/campaigns.md).
pub const LOAD_PRIOR: f64 = 0.005;

/// Difference between the currents of a simulation and the conditioned ones.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct CurrentShift {
    /// Delay, s.
    pub later_s: f64,
    /// Shift, in sigmas of the currents.
    pub spreads: f64,
}
