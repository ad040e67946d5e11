//! The interface in C: FMI 2.0 for co-simulation.
//!
//! From the bottom layer to the top: [`types`] of the standard; the [`logger`] and an `instance`; the `guard`, which every
//! call passes, and `access` to values of any type; and the functions of the standard: [`lifecycle`], [`values`],
//! [`stepping`] and [`state`].
//!
//! No panic leaves the library. What an importer does wrong is refused with a status of the standard and a message.

mod access;
mod guard;
mod instance;
pub mod lifecycle;
pub mod logger;
pub mod state;
pub mod stepping;
pub mod types;
pub mod values;
