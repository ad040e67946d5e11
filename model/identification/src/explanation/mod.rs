//! The explanation of a campaign, as steps from the model to the identified set of effects.

pub mod baseline;
pub mod constants;
pub mod diagnosis;
pub mod explain;
pub mod starting_point;
pub(crate) mod suspected_constants;
pub mod undetected;
