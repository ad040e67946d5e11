//! Draws a case of the second rig and writes its campaign to a folder, with what is hidden in it beside the folder.
//!
//! ```text
//! cargo run --release -p host-tests --example draw_campaign -- --seed 7 --effect flow-force --out /tmp/drawn
//! cargo run --release -- explain /tmp/drawn
//! ```

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::{Parser, ValueEnum};
use host_tests::second_rig::campaign_writer::{truth, write};
use host_tests::second_rig::draw::{Kind, Wish, draw};
use host_tests::second_rig::hideable::{Fidelity, Hideable, find};
use host_tests::second_rig::manoeuvres::Plan;
use host_tests::second_rig::test_stand::Family;

/// Draws a case of the second rig and writes its campaign.
#[derive(Debug, Parser)]
struct Arguments {
    /// What everything is drawn from.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The rig.
    #[arg(long, value_enum, default_value = "steady")]
    family: FamilyName,
    /// What is done with it.
    #[arg(long, value_enum, default_value = "lab")]
    plan: PlanName,
    /// The effect to hide, by its id; else one is drawn.
    #[arg(long, value_parser = effect)]
    effect: Option<&'static Hideable>,
    /// Its size, in its unit; else that is drawn.
    #[arg(long, requires = "effect", allow_negative_numbers = true)]
    size: Option<f64>,
    /// What kind of thing to hide if no effect is given.
    #[arg(long, value_enum)]
    kind: Option<KindName>,
    /// Whether hidden effects have structure that the textbook's form lacks.
    #[arg(long)]
    structured: Option<bool>,
    /// Whether noise is slow, weights are wrong and unnamed physics is about.
    #[arg(long)]
    rough: Option<bool>,
    /// Folder to write to.
    #[arg(long)]
    out: PathBuf,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FamilyName {
    Steady,
    Dynamic,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum PlanName {
    Lab,
    Field,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum KindName {
    Single,
    Pair,
    Nothing,
    Outside,
}

fn effect(id: &str) -> Result<&'static Hideable, String> {
    find(id).ok_or_else(|| "no such effect".to_owned())
}

fn main() -> Result<()> {
    let arguments = Arguments::parse();
    let wish = Wish {
        family: match arguments.family {
            FamilyName::Steady => Family::Steady,
            FamilyName::Dynamic => Family::Dynamic,
        },
        plan: match arguments.plan {
            PlanName::Lab => Plan::Lab,
            PlanName::Field => Plan::Field,
        },
        fidelity: arguments.structured.map(|structured| {
            if structured {
                Fidelity::Structured
            } else {
                Fidelity::Faithful
            }
        }),
        rough: arguments.rough,
        kind: arguments.kind.map(|kind| match kind {
            KindName::Single => Kind::Single,
            KindName::Pair => Kind::Pair,
            KindName::Nothing => Kind::Nothing,
            KindName::Outside => Kind::Outside,
        }),
        effect: arguments.effect.map(|what| (what, arguments.size)),
        known: |_| true,
    };
    let case = draw(arguments.seed, &wish);
    write(&case, &arguments.out).context("the campaign is not written")?;
    println!("{:#}", truth(&case));
    Ok(())
}
