//! The other end of the ECU's bus: a tool that measures and calibrates over XCP.

mod calibration;
mod recording;
mod session;
mod slcan_client;

pub use calibration::{Written, write_calibration};
pub use recording::{CHANNELS, PERIOD_MS, Row, record};
pub use session::{Session, ToolError};
pub use slcan_client::SlcanClient;
