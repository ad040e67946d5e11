//! `hitch model`: creates a model file from data sheets, and fits its constants to a campaign.
pub mod fit;
pub mod new;

use clap::Subcommand;

use hitch_output::error::Error;

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
    /// Create a commented model file from data sheets; asks on a terminal
    New(new::Args),
    /// Fit the constants of a model to a campaign, with confidence intervals
    Fit(fit::Args),
}

/// Runs the command.
///
/// # Errors
/// The error of the subcommand.
pub fn run(args: &Args) -> Result<(), Error> {
    match &args.command {
        Command::New(args) => new::run(args),
        Command::Fit(args) => fit::run(args),
    }
}
