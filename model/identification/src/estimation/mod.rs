//! Least squares: sensitivities, nuisances projected out, fits, intervals.

pub mod bounded_minimum;
pub(crate) mod central_differences;
pub(crate) mod clock_synchronisation;
pub mod fit;
pub mod gram;
pub mod jacobian;
pub mod least_squares;
pub mod nuisance_projection;
pub mod profile_likelihood;
pub mod residual_columns;
pub mod slow_columns;
