//! What a hitch works against in the field, in SI units: forces of the soil, the implement's way into it, the ground's
//! shape, slip of the driven wheels, heave and pitch of the tractor, and the sensors that draft and slip control need.
//!
//! ```text
//!   depth of the links --> penetration --> draft, vertical force <-- soil at the share
//!        ^                                     |
//!        |                                     +--> axle loads --> slip --> ground and wheel speed
//!   body: heave, pitch <-- ground at both axles |
//!        ^--------------------------------------+
//! ```
//!
//! From the bottom layer to the top: [`noise`]; [`draft`] and [`strength`] of the soil; [`soil`] along the field,
//! [`implement`], [`terrain`], [`tyre`], [`body`], [`sensors`]; and [`tractor`], which steps all of them.
//! Equations, sources and constants: docs/field.md.
//!
//! Depends on no other crate of the project.
#![forbid(unsafe_code)]

pub mod body;
pub mod draft;
pub mod implement;
pub mod noise;
pub mod sensors;
pub mod soil;
pub mod strength;
pub mod terrain;
pub mod tractor;
pub mod tyre;
