//! What a fit leaves: lack of fit, where it is and what it depends on.

pub mod attribution;
pub mod lack_of_fit;
pub mod localization;
pub mod unsuitable_base;
