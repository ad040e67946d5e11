//! From a campaign to the physical effects that a model lacks.
//!
//! Folders, from below; none imports one above it:
//!
//! * [`data`]: what a campaign gives, prepared: an [`Experiment`];
//! * [`estimate`]: values of everything that is free;
//! * [`residuals`]: measured less simulated, whitened;
//! * [`estimation`]: sensitivities, least squares, nuisances projected out: a [`Fit`];
//! * [`adequacy`]: what a fit leaves, where, and what it depends on;
//! * [`selection`]: evidence, hold-out, penalty and probability of sets of effects;
//! * [`search`]: the dictionary and the best subsets of it;
//! * [`design`]: the experiment that tells two effects apart;
//! * [`explanation`]: the set that was found, as steps from the model to it;
//! * [`suggestion`]: a formula for what is left;
//! * [`base`]: constants of the base model, estimated from a campaign.
#![forbid(unsafe_code)]

pub mod adequacy;
pub mod base;
pub mod data;
pub mod design;
pub mod estimate;
pub mod estimation;
pub mod explanation;
pub mod residuals;
pub mod search;
pub mod selection;
pub mod suggestion;

pub use data::experiment::Experiment;
pub use estimation::fit::Fit;
pub use explanation::explain::{Explanation, Verdict, diagnose, explain, explain_with};
pub use search::candidates::Progress;
pub use search::subset::Options;
