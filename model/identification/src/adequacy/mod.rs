//! Adequacy of a fit: lack of fit, its location and the signals it depends on.

pub mod attribution;
pub mod lack_of_fit;
pub mod localization;
pub mod signal;
pub mod unsuitable_base;
