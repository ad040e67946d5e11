//! Client of the ECU's bus: measurement and calibration over XCP.

mod calibration;
mod recording;
mod session;
mod slcan_client;

pub use calibration::{Written, write_calibration};
pub use recording::{CHANNELS, PERIOD_MS, Row, record};
pub use session::{Session, ToolError};
pub use slcan_client::SlcanClient;
