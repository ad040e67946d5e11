//! Writes the data sheets and logs of the machine in docs/your-own-hitch.md.
//!
//! ```text
//! cargo run --release -p host-tests --example second_machine -- --out machine
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Parser;
use truth_rigs::category_three::files::write;

/// Writes the data sheets and logs of a hitch of category III.
#[derive(Debug, Parser)]
struct Arguments {
    /// Folder to write to
    #[arg(long)]
    out: PathBuf,
}

fn main() -> Result<()> {
    let Arguments { out } = Arguments::parse();
    write(&out).with_context(|| format!("{} is not written", out.display()))
}
