//! Physical effects beyond the paper's plant.
//!
//! * [`catalogue`]: the effects that the project knows, one file each;
//! * [`expression`]: formulas of a user's own, read, checked and evaluated;
//! * [`TermEffect`]: such a formula as an effect, like one of the catalogue.
//!
//! Depends on the plant's hooks, which it fills, and on nothing that uses it.
//!
//! ```
//! let friction = hitch_effects::find("coulomb-friction").expect("in the catalogue");
//! assert_eq!(friction.parameters()[0].unit, "N");
//! ```
#![forbid(unsafe_code)]

pub mod catalogue;
mod described;
pub mod expression;
mod term_effect;

pub use catalogue::{CATALOGUE, available, find};
pub use term_effect::TermEffect;
