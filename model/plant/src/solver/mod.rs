//! Solvers: the hydraulics at one instant, and two integrators of the piston's motion.

pub mod circuit;
pub mod dynamic;
pub mod flows;
pub mod forces;
pub mod moment;
pub mod openings;
pub mod root;
pub mod steady;
