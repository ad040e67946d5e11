//! A listener on the CAN bus, through any adapter: it has no way to send a frame.

use std::io;
use std::time::Instant;

use hitch_protocols::can::Frame;

use super::bus_address::BusAddress;
use super::can_client::Adapter;
use crate::xcp_tool::ListenMode;

/// The listener.
#[derive(Debug)]
pub struct CanListener {
    adapter: Adapter,
    mode: ListenMode,
}

impl CanListener {
    /// Opens the bus at 250 kbit/s, in listen-only mode where the adapter has it; bit rate and mode of a CAN interface
    /// are those of its configuration.
    ///
    /// # Errors
    /// If the adapter cannot be opened.
    pub fn open(address: &BusAddress) -> io::Result<Self> {
        let mut adapter = Adapter::connect(address)?;
        let mode = match &mut adapter {
            Adapter::Slcan(client) => client.listen()?,
            #[cfg(target_os = "linux")]
            Adapter::Interface(_) => ListenMode::AsConfigured,
        };
        Ok(Self { adapter, mode })
    }

    /// Behaviour of the adapter.
    pub const fn mode(&self) -> ListenMode {
        self.mode
    }

    /// The next data frame; `None` if none arrives before `deadline`.
    ///
    /// # Errors
    /// If the adapter is disconnected.
    pub fn receive(&mut self, deadline: Instant) -> io::Result<Option<Frame>> {
        self.adapter.receive(deadline)
    }
}
