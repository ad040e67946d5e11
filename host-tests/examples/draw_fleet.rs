//! Draws a fleet of machines of the second rig and writes their campaigns, one folder each, for trials of many
//! campaigns at once (docs/fleet.md).
//!
//! ```text
//! cargo run --release -p host-tests --example draw_fleet -- --machines 200 --out fleet
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Parser;
use rayon::prelude::*;
use truth_rigs::second_rig::campaign_writer::write;
use truth_rigs::second_rig::draw::draw;
use truth_rigs::second_rig::manoeuvres::Plan;
use truth_rigs::second_rig::test_stand::Family;
use truth_rigs::second_rig::wish_arguments::WishArguments;

/// Draws a fleet of machines and writes their campaigns.
#[derive(Debug, Parser)]
struct Arguments {
    /// Number of machines
    #[arg(long, default_value_t = 200)]
    machines: u64,
    /// What the first machine is drawn from; each next one has the next number
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The rig
    #[arg(long, value_enum, default_value = "steady")]
    family: Family,
    /// What is done with each machine
    #[arg(long, value_enum, default_value = "field")]
    plan: Plan,
    #[command(flatten)]
    wish: WishArguments,
    /// Folder to write the campaigns to
    #[arg(long)]
    out: PathBuf,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let wish = arguments.wish.wish(arguments.family, arguments.plan);
    println!(
        "seeds {} to {}",
        arguments.seed,
        arguments.seed + arguments.machines.saturating_sub(1)
    );
    (0..arguments.machines)
        .into_par_iter()
        .try_for_each(|index| {
            let case = draw(arguments.seed + index, &wish);
            let folder = arguments.out.join(format!("machine-{:05}", index + 1));
            write(&case, &folder).with_context(|| format!("{} is not written", folder.display()))
        })
}
