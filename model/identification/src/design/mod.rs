//! Design of the next experiment, if a campaign leaves two effects confounded or an error unexplained.
//!
//! * [`alternative`]: the angle between two effects on the present campaign.
//! * [`manoeuvre`]: the list of manoeuvres, relative to the machine as defined by [`template`]; [`levels`] has the
//!   currents, loads and pressures of a machine; [`plan`] defines a manoeuvre of one machine and simulates its log;
//!   [`feasibility`] checks whether the machine can carry it out.
//! * [`separation`]: the expected likelihood ratio of a manoeuvre between two rivals, after refitting the wrong one.
//! * [`next`]: the selection of a manoeuvre.
//! * [`proposal`]: the selected manoeuvre in full, with what the rivals expect of it.
//! * [`exploration`]: a manoeuvre that varies what an unexplained error depends on.
//! * [`sensor`]: an additional sensor, if no manoeuvre helps.

pub mod alternative;
pub mod error_map;
pub mod exploration;
pub mod feasibility;
pub mod levels;
pub mod manoeuvre;
pub mod next;
pub mod plan;
pub mod proposal;
pub mod sensor;
pub mod separation;
pub mod template;

pub use alternative::{Alternative, Replacement};
pub use next::{NextExperiment, next_experiment};
pub use proposal::{Expecting, Proposal};
pub use separation::{Pair, Rival};
