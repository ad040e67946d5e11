//! Design of the next experiment, if a campaign leaves two effects confounded.
//!
//! * [`alternative`]: the angle between two effects on the present campaign.
//! * [`manoeuvre`]: the list of manoeuvres; [`plan`] defines a manoeuvre and simulates its log.
//! * [`separation`]: the expected likelihood ratio of a manoeuvre between two rivals, after refitting the wrong one.
//! * [`next`]: the selection of a manoeuvre.
//! * [`sensor`]: an additional sensor, if no manoeuvre helps.

pub mod alternative;
pub mod manoeuvre;
pub mod next;
pub mod plan;
pub mod sensor;
pub mod separation;

pub use alternative::{Alternative, Replacement};
pub use next::{NextExperiment, next_experiment};
pub use separation::{Pair, Rival};
