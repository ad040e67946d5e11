//! What to measure next when a campaign leaves two effects alike.
//!
//! * [`alternative`]: how far apart two effects are on the campaign as it is, as an angle.
//! * [`manoeuvre`]: what could be measured, as data; [`plan`] says what a manoeuvre is and what log it leaves.
//! * [`separation`]: what a manoeuvre would tell of two rivals, once the wrong one has adapted.
//! * [`next`]: the choice among the manoeuvres.
//! * [`sensor`]: what to measure instead if no manoeuvre helps.

pub mod alternative;
pub mod manoeuvre;
pub mod next;
pub mod plan;
pub mod sensor;
pub mod separation;

pub use alternative::{Alternative, Place};
pub use next::{NextExperiment, next_experiment};
pub use separation::{Pair, Rival};
