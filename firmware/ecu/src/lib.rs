//! The ECU's application: from converter codes and frames to pulse widths and frames, one [`Ecu::tick`] per
//! millisecond.
//!
//! ```text
//! Samples, Panel -> Inputs -> (an implement's set point) -> Controller -> Drive
//!                                                              |
//!                    bus <-> Node, XCP slave <- measurements <-+-> calibration pages <-> flash
//! ```
//!
//! It may depend on all other crates of the firmware, and none of them on it. It is pure code on a [`Hardware`]
//! interface, which board, emulator and tests implement, so the same code has the same behaviour on all three.
//!
//! * `samples`, `converter`, `scaling`, `set_points`, `panel`, `panel_inputs`: from codes and contacts to inputs,
//! * `coil_driver`, `drive`, `enable_line`: from pulse widths to pins,
//! * `can_port`: the bus by a driver of `embedded-can`,
//! * `arbiter`, `status`: commands of an implement, and status to it,
//! * `bus_watch`: troubles of the CAN controller,
//! * `service`, `start_check`, `hardware`, `task_sequence_monitor`, `tick_timer`: storage, and the order and the time of it
//!   all,
//! * `application`, and [`link`] with `hosted_ecu` for one that runs in lock step with a host.
//!
//! The images are in `src/bin`.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod adc_code;
mod application;
mod arbiter;
mod bus_watch;
mod can_port;
mod coil_driver;
mod consent;
mod converter;
mod drive;
mod enable_line;
mod hardware;
mod hosted_ecu;
pub mod link;
mod panel;
mod panel_inputs;
mod samples;
mod scaling;
mod service;
mod set_points;
mod start_check;
mod status;
mod task_sequence_monitor;
mod tick_timer;

pub use adc_code::AdcCode;
pub use application::Ecu;
pub use can_port::CanPort;
pub use coil_driver::{CoilDriver, CoilDriverError};
pub use converter::Conversion;
pub use drive::{Compare, Drive};
pub use hardware::{Contacts, FlashRegions, Hardware};
pub use hosted_ecu::{HostedEcu, Probe};
pub use panel::{Contact, Panel};
pub use panel_inputs::PanelInputs;
pub use samples::{Samples, Signal};
pub use scaling::BoardScaling;
pub use start_check::StartCheck;
pub use task_sequence_monitor::{Kick, Task, TaskSequenceMonitor};
