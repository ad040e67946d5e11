//! Fit of the base model: the constants of its components, before any effect is added.
//!
//! Every constant has a prior ([`crate::constants`]). The flow curves of both valves are corrected point by point. Clocks
//! and loads are fitted as for effects. Constants that a campaign cannot determine keep their declared values and are listed
//! ([`outcome`]).
mod descent;
mod normal;
pub mod outcome;

pub use crate::constants::fitted::{CurvePoint, FittedConstant};
pub use outcome::{BaseFit, fit_base_model};
