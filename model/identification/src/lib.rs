//! Identification: finds the physical effects that a model lacks to explain a measured campaign.
//!
//! An [`Experiment`] is a prepared campaign; with a model it is a [`Problem`](data::problem::Problem). A [`Fit`] has the
//! values of the free parameters and what they leave of the residuals. The answer is an [`Explanation`].
//!
//! Modules from the bottom layer to the top; none imports one above it:
//!
//! * `parallel`: a function of many items on all processors;
//! * [`data`]: prepares the logs of a campaign: an [`Experiment`];
//! * [`constants`]: errors of the base model's constants, and their prior;
//! * [`estimate`]: values of all free parameters;
//! * [`residuals`]: measured minus simulated, whitened;
//! * [`estimation`]: sensitivities, least squares, projection of nuisance parameters: a [`Fit`];
//! * [`adequacy`]: lack of fit, its location, and the signals it depends on;
//! * [`selection`]: evidence, hold-out, complexity penalty and posterior probability of sets of effects;
//! * [`search`]: the dictionary and its best subsets;
//! * [`design`]: the experiment that discriminates between two effects;
//! * [`explanation`]: the selected set of effects, as steps from the model to it;
//! * [`suggestion`]: a formula for the remaining residuals;
//! * [`base`]: the constants of the base model, estimated from a campaign.
#![forbid(unsafe_code)]

pub mod adequacy;
pub mod base;
pub mod constants;
pub mod data;
pub mod design;
pub mod estimate;
pub mod estimation;
pub mod explanation;
mod parallel;
pub mod residuals;
pub mod search;
pub mod selection;
pub mod suggestion;

pub use data::experiment::Experiment;
pub use estimation::fit::Fit;
pub use explanation::diagnosis::diagnose;
pub use explanation::explain::{Explanation, Verdict, explain, explain_with};
pub use search::candidates::Progress;
pub use search::options::Options;
