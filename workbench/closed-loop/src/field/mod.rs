//! Hitch, controller, tractor and field in one loop.
//!
//! ```text
//! lever, settings -> controller -> coils -> hitch -> height of the lower links -> depth -> tractor on the field
//!                        ^                    ^                                                 |
//!                        +--- pins, speeds ---|-------------------------------------------------+
//!                                             +---------------- forces of the soil ------------+
//! ```

mod coupling;
mod fitted;
mod rig;
mod settings;

pub use coupling::{Coupling, OutOfReach, RAISED_DEG, TOUCH_DEG, check_reach};
pub use fitted::{NotFitted, fitted};
pub use rig::{FieldRig, FieldSample, LINK_DEPTH_M, Start};
pub use settings::Settings;
