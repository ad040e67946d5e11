//! Fit of the base model: the constants of its components, before any effect is added.
//!
//! Every constant has a prior: the declared value with the tolerance of data sheets ([`parameter`]). The flow curves of
//! both valves are corrected point by point, with a Gaussian process as a smoothness prior (`prior`). Clocks and loads
//! are fitted as for effects. Constants that a campaign cannot determine keep their declared values and are listed
//! ([`outcome`]).
mod correction;
mod descent;
mod normal;
pub mod outcome;
pub mod parameter;
mod prior;

pub use outcome::{BaseFit, CurvePoint, FittedConstant, fit_base_model};
