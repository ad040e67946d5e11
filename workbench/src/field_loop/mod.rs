//! Hitch, controller, tractor and field in one loop.
//!
//! ```text
//! lever, settings -> controller -> coils -> hitch -> height of the lower links -> depth -> tractor on the field
//!                        ^                    ^                                                 |
//!                        +--- pins, speeds ---|-------------------------------------------------+
//!                                             +---------------- forces of the soil ------------+
//! ```

pub mod coupling;
pub mod figures;
pub mod pass;
pub mod rig;
pub mod scenario;
pub mod show;
pub mod transport;
pub mod undulation;
