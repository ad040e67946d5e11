//! A real ECU on the CAN bus, which the page shows and never commands.
//!
//! `monitor` listens in a thread for all tabs, and opens a lost adapter again. `heard` keeps what one hitch on the bus
//! has sent: `measured` (currents, angle, pressures, by the clock of the ECU in `clock`), its status, and its trouble
//! codes (`trouble_codes`). `view` is the form for the page.
mod clock;
mod heard;
mod measured;
mod monitor;
mod state;
mod trouble_codes;
mod view;
mod words;

pub use monitor::{BusMonitor, Place};
