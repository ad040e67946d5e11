//! `hitch serve`: the interactive page, local only.
use std::path::{Path, PathBuf};

use hitch_ecu_host::ecu::Runner;
use hitch_ecu_host::xcp_tool::BusAddress;
use hitch_output::error::Error;
use hitch_page::{LoopSource, Source};
use hitch_results::arguments::baseline::BaselineArg;
use hitch_results::arguments::model::ModelArg;

/// Arguments of `hitch serve`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch serve\n  hitch serve lab-a --model dynamic --port 8080 --no-browser\n  hitch serve --ecu\n  \
    hitch serve --can 127.0.0.1:7701\n\n\
    With --ecu, the closed loop of the page is the firmware's image on an emulated Cortex-M4, as `hitch ecu` runs it, with \
    the present model as the plant. There is one ECU: one tab at a time has it, from Start to Stop, and a tab that is \
    closed or silent for 5 s gives it back. The page says when this computer is too slow for real time.\n\n\
    With --can, the closed loop of the page is a real ECU on its bus, shown read only: angle, currents, pressures, status and \
    trouble codes as the ECU sends them, in any number of tabs. Nothing is sent on the bus, and an slcan adapter is opened in \
    listen-only mode if it has one. A lost connection is opened again. With --tune, a button of the page writes the \
    calibration of the present model to the ECU as `hitch flash-calibration` does. Other XCP tools: docs/tuning-live.md."
)]
pub struct Args {
    /// Folder of the campaign; without this option, the demonstration campaign
    campaign: Option<PathBuf>,
    #[command(flatten)]
    model: ModelArg,
    #[command(flatten)]
    baseline: BaselineArg,
    /// Port on 127.0.0.1; 0 selects a free one
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
    /// Run the closed loop with the emulated ECU of `hitch ecu`, in real time, instead of the controller on this computer
    #[arg(long)]
    ecu: bool,
    /// Image of the emulated ECU; without this option, it is built from the sources
    #[arg(long, value_name = "FILE", requires = "ecu", conflicts_with = "host")]
    image: Option<PathBuf>,
    /// Run the application of the ECU on the host instead of the emulated processor
    #[arg(long, requires = "ecu")]
    host: bool,
    /// Show the ECU on this bus instead, read only: HOST:PORT of an slcan adapter such as `hitch ecu --can`, a CAN interface
    /// of Linux (can0), or the serial port of an slcan adapter (/dev/ttyACM0, COM3)
    #[arg(long, value_name = "BUS", conflicts_with = "ecu")]
    can: Option<BusAddress>,
    /// Offer to write the calibration of the present model to the ECU on the bus; the ECU accepts it only while the hitch is
    /// locked and the service switch is closed
    #[arg(long, requires = "can")]
    tune: bool,
    /// Print the address of the page without opening a browser
    #[arg(long)]
    no_browser: bool,
}

/// Runs the command until it is stopped with Ctrl-C.
///
/// # Errors
/// If the model file is invalid, the port is not available, the emulator or its image is missing, or the bus
/// cannot be opened. A fault of the campaign is shown on the page.
pub fn run(args: &Args) -> Result<(), Error> {
    let source = Source {
        campaign: args.campaign.clone(),
        model: args.model.load()?,
        baseline: args.baseline.folder().map(Path::to_owned),
    };
    hitch_page::run(source, args.loop_source()?, args.port, !args.no_browser)
}

impl Args {
    /// What runs the closed loop.
    fn loop_source(&self) -> Result<LoopSource, Error> {
        if let Some(address) = &self.can {
            return LoopSource::bus(address.clone(), self.tune);
        }
        Ok(match (self.ecu, self.host) {
            (false, _) => LoopSource::Host,
            (true, true) => LoopSource::ecu(Runner::Host),
            (true, false) => LoopSource::ecu(Runner::emulator(self.image.as_deref())?),
        })
    }
}
