//! A node on the CAN bus, through any adapter.

use std::io;
use std::time::Instant;

use hitch_protocols::can::Frame;

use super::bus_address::BusAddress;
#[cfg(target_os = "linux")]
use super::can_interface::CanInterface;
use super::slcan_client::SlcanClient;

/// The node.
#[derive(Debug)]
pub struct CanClient(Adapter);

/// A connection to an adapter.
#[derive(Debug)]
pub(super) enum Adapter {
    Slcan(SlcanClient),
    #[cfg(target_os = "linux")]
    Interface(CanInterface),
}

impl CanClient {
    /// Opens the bus at 250 kbit/s; the bit rate of a CAN interface is that of its configuration.
    ///
    /// # Errors
    /// If the adapter cannot be opened.
    pub fn open(address: &BusAddress) -> io::Result<Self> {
        let mut adapter = Adapter::connect(address)?;
        match &mut adapter {
            Adapter::Slcan(client) => client.open()?,
            #[cfg(target_os = "linux")]
            Adapter::Interface(_) => {}
        }
        Ok(Self(adapter))
    }

    /// Sends a frame.
    ///
    /// # Errors
    /// If the adapter is disconnected or does not accept the frame.
    pub fn send(&mut self, frame: &Frame) -> io::Result<()> {
        match &mut self.0 {
            Adapter::Slcan(client) => client.send(frame),
            #[cfg(target_os = "linux")]
            Adapter::Interface(interface) => interface.send(frame),
        }
    }

    /// The next data frame; `None` if none arrives before `deadline`.
    ///
    /// # Errors
    /// If the adapter is disconnected.
    pub fn receive(&mut self, deadline: Instant) -> io::Result<Option<Frame>> {
        self.0.receive(deadline)
    }
}

impl Adapter {
    /// Connects to an adapter; the channel of an slcan adapter is not yet opened.
    ///
    /// # Errors
    /// If the adapter cannot be reached.
    pub(super) fn connect(address: &BusAddress) -> io::Result<Self> {
        Ok(match address {
            BusAddress::Tcp(address) => Self::Slcan(SlcanClient::connect(address)?),
            BusAddress::Serial(port) => Self::Slcan(SlcanClient::open_serial(port)?),
            #[cfg(target_os = "linux")]
            BusAddress::Interface(name) => Self::Interface(CanInterface::open(name)?),
            #[cfg(not(target_os = "linux"))]
            BusAddress::Interface(_) => {
                return Err(io::Error::new(
                    io::ErrorKind::Unsupported,
                    "CAN interfaces need Linux",
                ));
            }
        })
    }

    /// The next data frame; `None` if none arrives before `deadline`.
    ///
    /// # Errors
    /// If the adapter is disconnected.
    pub(super) fn receive(&mut self, deadline: Instant) -> io::Result<Option<Frame>> {
        match self {
            Self::Slcan(client) => client.receive(deadline),
            #[cfg(target_os = "linux")]
            Self::Interface(interface) => interface.receive(deadline),
        }
    }
}
