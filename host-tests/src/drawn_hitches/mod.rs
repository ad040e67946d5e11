//! The controller on hitches that it has never met, taught or not: drawn from a seed, driven through what
//! `hitch controller` is told and answers.
//!
//! ```text
//! draw      a seed -> a machine of the second rig, its sensors, and the moves that are asked of it
//! shortest  the shortest manoeuvre that this machine allows for a move
//! teaching  the firmware teaches itself the machine, as service does it
//! session   power-up, picking the hitch up, the moves, and the minute after the last
//! figures   what the bars of motion are about, and who is worst
//! ```

pub mod draw;
pub mod figures;
pub mod session;
pub mod shortest;
pub mod teaching;
