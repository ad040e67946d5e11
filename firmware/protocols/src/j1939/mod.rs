//! The hitch on the tractor's bus: J1939 and ISO 11783 (ISOBUS) over 250 kbit/s CAN.
//!
//! [`Node`] combines all of it: it claims an address, reports the hitch ten times a second, accepts commands from an
//! implement, reports faults, and answers requests. The other modules are its parts, each a table or a state machine.
//!
//! No call blocks: [`Node::receive`] takes a frame, [`Node::poll`] returns the next one that is due. Both do a bounded
//! amount of work, and the number of answers per second is bounded for any bus traffic.

mod address_book;
mod asking;
mod automation;
mod button_monitor;
pub mod claim;
pub mod diagnostics;
pub mod engine;
mod ground_speed;
pub mod heartbeat;
pub mod hitch;
mod id;
mod machine_speed;
pub mod measured;
mod name;
mod node;
pub mod reception;
pub mod remote;
pub mod request;
mod scale;
mod tim;
mod time;
pub mod transport;
pub mod trouble;
mod trouble_finder;

pub use automation::{Automation, Operation};
pub use diagnostics::Variant;
pub use hitch::{Draft, ExitCode, HitchCommand, HitchStatus, InWork, Limit, LimitStatus};
pub use id::{GLOBAL, Id, NULL, Pgn};
pub use measured::MeasuredBroadcast;
pub use name::{Name, NameFields};
pub use node::{Node, PREFERRED_ADDRESS, Settings};
pub use remote::Remote;
pub use tim::Authority;
pub use trouble::{Trouble, Troubles};
pub use trouble_finder::TroubleFinder;
