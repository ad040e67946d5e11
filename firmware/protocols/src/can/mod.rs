//! Classic CAN: frames, and their text form for serial lines and sockets.

mod frame;
pub mod slcan;

pub use embedded_can::{ExtendedId, Id, StandardId};
pub use frame::Frame;
pub(crate) use frame::extended_id;
