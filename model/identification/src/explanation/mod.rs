//! The set of effects stated as steps from the model to it.

pub mod explain;
pub mod undetected;
