//! The ECU's application: from converter codes and frames to pulse widths and frames, one [`Ecu::tick`] a millisecond.
//!
//! ```text
//! Samples, Panel -> Inputs -> (an implement's set point) -> Controller -> Drive
//!                                                              |
//!                    bus <-> Node, XCP slave <- measurements <-+-> calibration pages <-> flash
//! ```
//!
//! It may depend on all other crates of the firmware, and none of them on it. Pure as they are: what it runs on is a
//! [`Hardware`], which the board, the emulator and the tests each have one of. So the same code runs on all three, and
//! does the same.
//!
//! * `converter`, `scaling`, `panel`, `panel_inputs`: from codes and contacts to inputs,
//! * `coil_driver`, `drive`, `enable_line`: from pulse widths to pins,
//! * `arbiter`, `status`: what an implement asks for, and what it is told,
//! * `service`, `hardware`, `flow`, `pace`: storage, and the order and the time of it all,
//! * `application`, and [`link`] with `machine` for one that runs in lock step with a host.
//!
//! The images are in `src/bin`.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod application;
mod arbiter;
mod coil_driver;
mod converter;
mod drive;
mod enable_line;
mod hardware;
mod hosted_ecu;
pub mod link;
mod panel;
mod panel_inputs;
mod scaling;
mod service;
mod status;
mod task_sequence_monitor;
mod tick_timer;

pub use application::Ecu;
pub use coil_driver::{CoilDriver, CoilDriverError};
pub use converter::{AdcCode, Conversion, Samples, Signal};
pub use drive::{Compare, Drive};
pub use hardware::{Contacts, FlashRegions, Hardware};
pub use hosted_ecu::{HostedEcu, Probe};
pub use panel::{Contact, Panel};
pub use panel_inputs::PanelInputs;
pub use scaling::BoardScaling;
pub use task_sequence_monitor::{Kick, Task, TaskSequenceMonitor};
