//! The interface in C: FMI 2.0 and 3.0 for co-simulation, in one library.
//!
//! From the bottom layer to the top: [`types`] of the standard; the `logger` and an `instance`; the `guard`, which every
//! call passes; what both versions do alike: `lifecycle`, `access` to values, `stored` states; and the functions of
//! [`fmi2`] and [`fmi3`].
//!
//! No panic leaves the library. What an importer does wrong is refused with a status of the standard and a message.

mod access;
pub mod fmi2;
pub mod fmi3;
mod guard;
mod instance;
mod lifecycle;
pub mod logger;
mod stored;
pub mod types;
