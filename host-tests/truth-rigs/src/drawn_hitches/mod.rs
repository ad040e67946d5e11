//! The controller on unknown hitches, taught or not: drawn from a seed, and driven through the interface of `hitch
//! controller`.
//!
//! ```text
//! draw      a seed -> a machine of the second rig, its sensors, and its moves
//! shortest  the shortest manoeuvre that this machine allows for a move
//! teaching  the firmware's teaching of this machine, as in service session   power-up, lever capture, the moves, and
//! the minute after the last figures   the figures of the motion limits, and the worst cases
//! ```

pub mod draw;
pub mod figures;
pub mod plain;
pub mod session;
pub mod shortest;
pub mod teaching;
