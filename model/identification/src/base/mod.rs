//! Fit of the base model: the constants of its components, as the paper fits them, before any effect is added.
//!
//! Every constant has a prior: the declared value with the tolerance that data sheets leave ([`parameter`]). The flow
//! curves of both valves are corrected point by point, smoothed by a Gaussian process (`prior`). Clocks and loads are
//! fitted as for effects. What a campaign cannot determine stays as it is declared and is named ([`outcome`]).
mod correction;
mod descent;
mod normal;
pub mod outcome;
pub mod parameter;
mod prior;

pub use outcome::{BaseFit, CurvePoint, FittedConstant, fit_base_model};
