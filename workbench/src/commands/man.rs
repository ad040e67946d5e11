//! `hitch man`: manual pages, in the format of `man`.

use std::io;

use clap_mangen::Man;

use hitch_output::error::Error;

/// Arguments of `hitch man`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch man | man -l -\n  hitch man model fit > hitch-model-fit.1"
)]
pub struct Args {
    /// Command that the page describes; without one, the page of the program
    #[arg(value_name = "COMMAND")]
    command: Vec<String>,
}

/// Prints a page of the program `hitch`.
///
/// # Errors
/// If the command does not exist, or standard output is closed or full.
pub fn run(args: &Args, mut hitch: clap::Command) -> Result<(), Error> {
    // Names the inner commands in full, as in `hitch-model-fit`.
    hitch.build();
    let mut command = &hitch;
    for name in &args.command {
        command = command.find_subcommand(name).ok_or_else(|| {
            Error::Usage(format!(
                "hitch has no command {:?}; hitch --help lists the commands",
                args.command.join(" ")
            ))
        })?;
    }
    let page = page(command.clone())
        .map_err(|error| Error::Failed(format!("the page cannot be written: {error}")))?;
    hitch_output::print(&String::from_utf8_lossy(&page))
}

fn page(command: clap::Command) -> io::Result<Vec<u8>> {
    let mut page = Vec::new();
    Man::new(command).manual("hitch").render(&mut page)?;
    Ok(page)
}
