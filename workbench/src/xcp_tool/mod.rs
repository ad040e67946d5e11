//! Client of the ECU's bus: measurement and calibration over XCP.

mod bus_address;
mod calibration;
mod can_client;
#[cfg(target_os = "linux")]
mod can_interface;
mod recording;
mod session;
mod slcan_client;

pub use bus_address::BusAddress;
pub use calibration::{Written, write_calibration};
pub use can_client::CanClient;
pub use recording::{CHANNELS, PERIOD_MS, Row, record};
pub use session::{Session, ToolError};
