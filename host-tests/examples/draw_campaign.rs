//! Draws a case of the second rig and writes its campaign to a folder, with what is hidden in it beside the folder.
//!
//! ```text
//! cargo run --release -p host-tests --example draw_campaign -- --seed 7 --effect flow-force --out drawn
//! cargo run --release -- explain drawn
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Parser;
use truth_rigs::second_rig::campaign_writer::{truth, write};
use truth_rigs::second_rig::draw::draw;
use truth_rigs::second_rig::manoeuvres::Plan;
use truth_rigs::second_rig::test_stand::Family;
use truth_rigs::second_rig::wish_arguments::WishArguments;

/// Draws a case of the second rig and writes its campaign.
#[derive(Debug, Parser)]
struct Arguments {
    /// What everything is drawn from
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The rig
    #[arg(long, value_enum, default_value = "steady")]
    family: Family,
    /// What is done with it
    #[arg(long, value_enum, default_value = "lab")]
    plan: Plan,
    #[command(flatten)]
    wish: WishArguments,
    /// Folder to write to
    #[arg(long)]
    out: PathBuf,
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let wish = arguments.wish.wish(arguments.family, arguments.plan);
    let case = draw(arguments.seed, &wish);
    write(&case, &arguments.out).context("the campaign is not written")?;
    println!("{:#}", truth(&case));
    Ok(())
}
