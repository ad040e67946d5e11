//! `hitch flash-calibration`: writes a calibration to a running ECU, over XCP.
use std::io::ErrorKind;
use std::path::PathBuf;

use hitch_controller_host::calibration_file;

use crate::error::Error;
use crate::output;
use crate::progress::Progress;
use crate::xcp_tool::{Session, SlcanClient, ToolError, write_calibration};

/// Arguments of `hitch flash-calibration`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch flash-calibration calibration.toml --can 127.0.0.1:7701\n\n\
    The hitch has to be locked (`lock on`) and the service switch closed (`service on`). Only changed values are \
    written. The ECU then stores the calibration, and all values are verified from flash."
)]
pub struct Args {
    /// Calibration file, as written by `hitch calibrate` and `hitch tune`
    #[arg(value_name = "C.toml")]
    calibration: PathBuf,
    /// The ECU's bus: an slcan adapter on TCP, such as `hitch ecu --can`
    #[arg(long, value_name = "HOST:PORT")]
    can: String,
}

/// Runs the command.
///
/// # Errors
/// If the calibration is invalid, the ECU cannot be reached, or it refuses.
pub fn run(args: &Args) -> Result<(), Error> {
    let calibration = calibration_file::read(&args.calibration)?;
    let progress = Progress::start("writing the calibration");
    let mut session = connect(&args.can)?;
    let written = write_calibration(&mut session, &calibration).map_err(tool_error)?;
    session.close().map_err(tool_error)?;
    drop(progress);
    output::print(&format!(
        "{} of {} values changed; stored and verified.\n",
        written.changed, written.words
    ))
}

/// Connects to the ECU at an address.
///
/// # Errors
/// If there is no ECU.
pub fn connect(address: &str) -> Result<Session, Error> {
    let client = SlcanClient::connect(address).map_err(|error| {
        Error::Usage(match error.kind() {
            ErrorKind::InvalidInput => {
                format!("--can {address}: {error}; give a host and a port, as in 127.0.0.1:7701")
            }
            _ => format!(
                "--can {address}: no answer: {error}; start `hitch ecu --can {address}` or give the address of an slcan adapter"
            ),
        })
    })?;
    Session::open(client).map_err(tool_error)
}

/// A fault that the user can correct is an input error; others are failures.
pub fn tool_error(error: ToolError) -> Error {
    match error {
        ToolError::Locked
        | ToolError::NotAtRest
        | ToolError::OutOfRange(_)
        | ToolError::NoHitch
        | ToolError::OtherEcu(_) => Error::Usage(error.to_string()),
        other => Error::Failed(other.to_string()),
    }
}
