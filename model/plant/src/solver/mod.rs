//! The hydraulics at one instant, and the two ways to move the piston.

pub mod circuit;
pub mod dynamic;
pub mod forces;
pub mod moment;
pub mod root;
pub mod steady;
