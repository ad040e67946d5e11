//! What a hitch works against in the field, in SI units: the soil and the implement's way into it, the ground, tyres and the tractor's body.
//!
//! Depends on no other crate of the project.
#![forbid(unsafe_code)]

pub mod body;
pub mod draft;
pub mod implement;
pub mod noise;
pub mod soil;
pub mod strength;
pub mod terrain;
pub mod tyre;
