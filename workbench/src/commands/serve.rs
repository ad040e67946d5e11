//! `hitch serve`: the interactive page, local only.
use std::path::PathBuf;

use crate::error::Error;
use crate::model_arg::ModelArg;
use crate::serve::{self, Source};

/// Arguments of `hitch serve`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch serve\n  hitch serve lab-a --model dynamic --port 8080 --no-browser"
)]
pub struct Args {
    /// Folder of the campaign; without this option, the demonstration campaign
    campaign: Option<PathBuf>,
    #[command(flatten)]
    model: ModelArg,
    /// Port on 127.0.0.1; 0 selects a free one
    #[arg(long, value_name = "PORT", default_value_t = 0)]
    port: u16,
    /// Print the address of the page without opening a browser
    #[arg(long)]
    no_browser: bool,
}

/// Runs the command until it is stopped with Ctrl-C.
///
/// # Errors
/// If the model file is invalid, or the port is not available. A fault of the campaign is shown on the page.
pub fn run(args: &Args) -> Result<(), Error> {
    let source = Source {
        campaign: args.campaign.clone(),
        model: args.model.load()?,
    };
    serve::run(source, args.port, !args.no_browser)
}
