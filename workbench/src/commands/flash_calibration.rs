//! `hitch flash-calibration`: writes a calibration to a running ECU, over XCP.
use std::path::PathBuf;

use hitch_controller_host::calibration_file;

use hitch_ecu_host::xcp_tool::{BusAddress, read_key, write_to};
use hitch_output::error::Error;
use hitch_output::progress::Progress;

/// Arguments of `hitch flash-calibration`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch flash-calibration calibration.toml --can 127.0.0.1:7701\n\n\
    The hitch has to be locked (`lock on`) and the service switch closed (`service on`). Only changed values are \
    written, and safety values only if they become stricter, unless the key is given. The ECU then stores the calibration, and all values are verified from flash."
)]
pub struct Args {
    /// Calibration file, as written by `hitch calibrate` and `hitch tune`
    #[arg(value_name = "C.toml")]
    calibration: PathBuf,
    /// The ECU's bus: HOST:PORT of an slcan adapter such as `hitch ecu --can`, a CAN interface of Linux (can0), or the serial
    /// port of an slcan adapter (/dev/ttyACM0, COM3)
    #[arg(long, value_name = "BUS")]
    can: BusAddress,
    /// File with the key of this machine, 64 hexadecimal digits: required if a safety value becomes looser
    #[arg(long, value_name = "FILE")]
    key: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// If the calibration is invalid, the ECU cannot be reached, or it refuses.
pub fn run(args: &Args) -> Result<(), Error> {
    let calibration = calibration_file::read(&args.calibration)?;
    let key = args.key.as_deref().map(read_key).transpose()?;
    let progress = Progress::start("writing the calibration");
    let written = write_to(&args.can, &calibration, key.as_ref())?;
    drop(progress);
    hitch_output::print(&format!(
        "{} of {} values changed; stored and verified.\n",
        written.changed, written.words
    ))
}
