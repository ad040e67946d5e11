//! Connection to the ECU at an address, and its errors for people.

use hitch_protocols::key::Secret;
use hitch_quantities::ValidCalibration;

use super::bus_address::BusAddress;
use super::calibration::{Written, write_calibration};
use super::can_client::CanClient;
use super::session::{Session, ToolError};
use hitch_output::error::Error;

/// Connects to the ECU at an address.
///
/// # Errors
/// If there is no ECU.
pub fn connect(address: &BusAddress) -> Result<Session, Error> {
    let client = CanClient::open(address).map_err(|error| address.unreachable(&error))?;
    Session::open(client).map_err(tool_error)
}

/// Writes a calibration to the ECU at an address, which stores it. `key` is used if safety values are loosened.
///
/// # Errors
/// If the ECU cannot be reached, or it refuses.
pub fn write_to(
    address: &BusAddress,
    calibration: &ValidCalibration,
    key: Option<&Secret>,
) -> Result<Written, Error> {
    let mut session = connect(address)?;
    let written = write_calibration(&mut session, calibration, key).map_err(interrupted)?;
    session.close().map_err(tool_error)?;
    Ok(written)
}

/// The error of a write; after a lost connection, values may have been written without having been stored.
fn interrupted(error: ToolError) -> Error {
    match error {
        ToolError::Bus(_) | ToolError::Silent => Error::Usage(format!(
            "{error}; the write is incomplete: write again, or switch the ECU off and on to return to the stored calibration"
        )),
        other => tool_error(other),
    }
}

/// A fault that the user can correct is an input error; others are failures.
pub fn tool_error(error: ToolError) -> Error {
    match error {
        ToolError::Refused(_) | ToolError::NotStored => Error::Failed(error.to_string()),
        other => Error::Usage(other.to_string()),
    }
}
