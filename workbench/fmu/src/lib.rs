//! Plant and controller as co-simulation units of FMI 2.0 (docs/fmu.md).
//!
//! From the bottom layer to the top: the [`variable`]s of a unit and their [`Value`](variable::Value)s; the [`component`], which is what a unit simulates, with [`plant`] and [`controller`]; the
//! [`content`] that a unit carries, and its [`description`] for importers; and the interface in C, which is what the
//! shared library exports.
//!
//! Only the interface has unsafe code: it takes pointers from the importing tool.
#![deny(unsafe_code)]
#![deny(clippy::undocumented_unsafe_blocks)]

#[allow(unsafe_code, reason = "an importer hands over pointers")]
pub mod abi;
pub mod component;
pub mod content;
pub mod controller;
pub mod description;
pub mod kind;
mod location;
pub mod plant;
mod units;
pub mod variable;
