//! Client of the ECU's bus: measurement and calibration over XCP, and a listener.

mod bus_address;
mod calibration;
mod can_client;
#[cfg(target_os = "linux")]
mod can_interface;
mod can_listener;
mod connection;
mod key_file;
mod listen_mode;
mod patience;
mod recording;
mod session;
mod slcan_client;

pub use bus_address::BusAddress;
pub use calibration::{Written, write_calibration};
pub use can_client::CanClient;
pub use can_listener::CanListener;
pub use connection::{connect, tool_error, write_to};
pub use key_file::read_key;
pub use listen_mode::ListenMode;
pub use recording::{CHANNELS, PERIOD_MS, Recording, Row, record};
pub use session::{Session, ToolError};
