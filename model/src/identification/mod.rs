//! From a campaign to what the model lacks.

pub mod adequacy;
pub mod attribution;
pub mod candidate;
pub mod clocks;
pub mod conditioning;
pub mod design;
pub mod estimate;
pub mod evidence;
pub mod experiment;
pub mod explain;
pub mod fit;
pub mod frame;
pub mod holdout;
pub mod jacobian;
pub mod noise;
pub mod regime;
pub mod residual;
mod scan;
mod shortlist;
mod starts;
pub mod suggestion;
mod synchronise;
pub mod traces;
pub mod trials;
pub mod twins;
pub mod unseen;
pub mod whereabouts;
