//! Where physical effects act: the hooks that they fill, the signals and readings that they see.

pub mod effect;
pub mod effect_hooks;
pub mod place;
pub mod reading;
pub mod signals;
