//! The ECU's application: from converter codes and frames to pulse widths and frames, one [`Ecu::tick`] a millisecond.
//!
//! ```text
//! Samples, Panel -> Inputs -> (an implement's set point) -> Controller -> Drive
//!                                                              |
//!                    bus <-> Node, XCP slave <- measurements <-+-> calibration pages <-> flash
//! ```
//!
//! Pure as the rest of the library: what it runs on is a [`Hardware`], which the board, the emulator and the tests each
//! have one of. So the same code runs on all three, and does the same.

mod application;
mod arbiter;
mod coil_driver;
mod converter;
mod drive;
mod enable_line;
pub mod fault_history;
mod flow;
mod hardware;
pub mod link;
mod machine;
mod pace;
mod panel;
mod panel_inputs;
mod scaling;
mod service;
mod status;

pub use application::Ecu;
pub use coil_driver::{CoilDriver, CoilDriverError};
pub use converter::{AdcCode, Conversion, Samples, Signal};
pub use drive::{Compare, Drive};
pub use flow::{FlowMonitor, Kick, Task};
pub use hardware::{Contacts, FlashRegions, Hardware};
pub use machine::{Machine, Probe};
pub use panel::{Contact, Panel};
pub use panel_inputs::PanelInputs;
pub use scaling::BoardScaling;
