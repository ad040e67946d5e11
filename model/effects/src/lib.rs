//! Physical effects that extend the paper's plant.
//!
//! * [`catalogue`]: the known effects, one per file;
//! * [`expression`]: user-defined formulas: parsing, checking, evaluation;
//! * [`TermEffect`]: a user-defined formula as an effect.
//!
//! The crate depends on the hooks of the plant, to which it attaches effects.
//!
//! ```
//! let friction = hitch_effects::find("coulomb-friction").expect("in the catalogue");
//! assert_eq!(friction.parameters()[0].unit, "N");
//! ```
#![forbid(unsafe_code)]

pub mod catalogue;
mod described;
pub mod expression;
mod order;
mod term_effect;

pub use catalogue::{CATALOGUE, available, find};
pub use term_effect::TermEffect;
