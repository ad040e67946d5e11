//! Errors of the base model's constants: their prior, and models with corrected constants.
//!
//! Every constant has a prior: the declared value with the tolerance of data sheets ([`parameter`]). The errors of a
//! flow curve are smooth over the current ([`prior`]). [`directions`] describes all errors by independent coordinates
//! with unit variance, so that they take part in a fit like the offset of a clock.

pub mod correction;
pub mod directions;
pub mod fitted;
pub mod free;
pub mod movable;
pub mod parameter;
pub mod prior;
pub mod tolerances;
