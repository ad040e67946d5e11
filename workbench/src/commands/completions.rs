//! `hitch completions`: completions of a shell for the program's commands and options.

use clap_complete::Shell;

use hitch_output::error::Error;

/// Arguments of `hitch completions`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch completions bash > ~/.local/share/bash-completion/completions/hitch\n  \
    hitch completions zsh > ~/.zfunc/_hitch\n  hitch completions fish > ~/.config/fish/completions/hitch.fish"
)]
pub struct Args {
    /// Shell that reads the completions
    #[arg(value_enum)]
    shell: Shell,
}

/// Prints the completions of the program `hitch`.
///
/// # Errors
/// If standard output is closed or full.
pub fn run(args: &Args, mut hitch: clap::Command) -> Result<(), Error> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut hitch, "hitch", &mut script);
    hitch_output::print(&String::from_utf8_lossy(&script))
}
