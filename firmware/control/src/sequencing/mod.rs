//! Which coil may be on when: the check valve's conditions and the compensator's, and a hitch that leaves its place.

pub mod saturation;
pub mod sink;
pub mod valve_logic;
