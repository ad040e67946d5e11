//! `hitch model`: a model file from data sheets, and its constants from a campaign.
pub mod fit;
pub mod new;

use clap::Subcommand;

use crate::error::Error;

/// Arguments of `hitch model`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch model new --out my-hitch.toml\n  hitch model fit lab-a --model my-hitch.toml --out fitted.toml"
)]
pub struct Args {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// A commented model file, filled in from data sheets; asks on a terminal
    New(new::Args),
    /// The constants of a model from a campaign, each with its interval
    Fit(fit::Args),
}

/// Runs the command.
///
/// # Errors
/// Whatever the subcommand reports.
pub fn run(args: &Args) -> Result<(), Error> {
    match &args.command {
        Command::New(args) => new::run(args),
        Command::Fit(args) => fit::run(args),
    }
}
