//! The hooks where physical effects act, and the signals and readings of the plant.

pub mod acting;
pub mod effect;
pub mod effect_hooks;
pub mod elements;
pub mod place;
pub mod reading;
pub mod signals;
