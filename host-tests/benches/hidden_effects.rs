//! Detection rates of hidden effects: cases of the second rig, answered by `hitch explain`.
//!
//! ```text
//! cargo bench -p host-tests --bench hidden_effects -- --count 40 --family steady --plan lab
//! cargo bench -p host-tests --bench hidden_effects -- --count 40 --family steady --plan lab --foreign
//! ```
//!
//! Prints a Markdown table for each family and plan, and every failure with the command that repeats it. The rig shares no equation with the fitted model.

use clap::Parser;
use host_tests::markdown;
use indicatif::{ProgressBar, ProgressStyle};
use truth_rigs::hidden_effects::foreign::Adopted;
use truth_rigs::hidden_effects::grade::{Graded, Posed};
use truth_rigs::hidden_effects::starting_point;
use truth_rigs::hidden_effects::tally::{BINS, Tally, quantile};
use truth_rigs::hidden_effects::wrong_base::declared_within;
use truth_rigs::second_rig::draw::{Kind, draw};
use truth_rigs::second_rig::manoeuvres::Plan;
use truth_rigs::second_rig::test_stand::Family;
use truth_rigs::second_rig::wish_arguments::WishArguments;

/// Name of what answers, in tables.
const NAME: &str = "hitch explain";

/// How often is the hidden effect named?
#[derive(Debug, Parser)]
struct Arguments {
    /// Seed of the first case; the next ones count up
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Cases for each family and plan
    #[arg(long, default_value_t = 20)]
    count: u64,
    /// Families of rigs
    #[arg(
        long,
        value_enum,
        value_delimiter = ',',
        default_value = "steady,dynamic"
    )]
    family: Vec<Family>,
    /// Plans of campaigns
    #[arg(long, value_enum, value_delimiter = ',', default_value = "lab,field")]
    plan: Vec<Plan>,
    #[command(flatten)]
    wish: WishArguments,
    /// Machines that differ from their data sheet in every constant and have structural differences: what has changed
    /// between two campaigns?
    #[arg(long, conflicts_with_all = ["effect", "kind", "fidelity", "rough"])]
    foreign: bool,
    /// Declared models that differ from the machine in every constant, as data sheets do
    #[arg(long, conflicts_with = "foreign")]
    wrong_base: bool,
    /// Errors of those constants, as a share of the tolerances of data sheets
    #[arg(long, default_value_t = 1.0, requires = "wrong_base")]
    base_error: f64,
    /// Given by cargo
    #[arg(long, hide = true)]
    bench: bool,
}

fn main() {
    let arguments = Arguments::parse();
    let groups = arguments.family.len() * arguments.plan.len();
    let bar = ProgressBar::new(groups as u64 * arguments.count).with_style(
        ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed} {msg}")
            .expect("a sound template"),
    );
    for &family in &arguments.family {
        for &plan in &arguments.plan {
            if arguments.foreign {
                let machines = foreign_machines(&arguments, family, plan, &bar);
                bar.suspend(|| show_foreign(&machines, family, plan));
                continue;
            }
            let answers = answers(&arguments, family, plan, &bar);
            bar.suspend(|| show(&arguments, &answers, family, plan));
        }
    }
    bar.finish_and_clear();
}

fn answers(arguments: &Arguments, family: Family, plan: Plan, bar: &ProgressBar) -> Vec<Graded> {
    let seeds = arguments.seed..arguments.seed + arguments.count;
    let answers = seeds.map(|seed| {
        let posed = Posed::new(draw(seed, &arguments.wish.wish(family, plan)));
        let declared = if arguments.wrong_base {
            declared_within(family, seed, arguments.base_error)
        } else {
            starting_point(family)
        };
        bar.set_message(format!("{family:?} {plan:?} {seed}"));
        let graded = posed.ask_about(&declared);
        bar.inc(1);
        let verdict = if graded.good() { "good" } else { "miss" };
        let line = format!(
            "{family:?} {plan:?} {seed} {NAME}: {verdict}, {:.2?} in {:.1} s",
            graded.answer.confidences, graded.seconds
        );
        bar.suspend(|| eprintln!("{line}"));
        graded
    });
    answers.collect()
}

/// A foreign machine with the answer on its changes.
struct Machine {
    adopted: Adopted,
    graded: Graded,
    /// Error in a third campaign of the model that was found, in sigmas.
    error: f64,
}

fn foreign_machines(
    arguments: &Arguments,
    family: Family,
    plan: Plan,
    bar: &ProgressBar,
) -> Vec<Machine> {
    let seeds = arguments.seed..arguments.seed + arguments.count;
    let machines = seeds.map(|seed| {
        bar.set_message(format!("{family:?} {plan:?} {seed}"));
        let adopted = Adopted::new(seed, family, plan);
        let graded = adopted.ask();
        bar.inc(1);
        let machine = Machine {
            error: adopted.error_elsewhere(&graded.answer.model),
            adopted,
            graded,
        };
        let line = told(&machine);
        bar.suspend(|| eprintln!("{line}"));
        machine
    });
    machines.collect()
}

/// A machine and the answer, as text.
fn told(machine: &Machine) -> String {
    let Machine {
        adopted,
        graded,
        error,
    } = machine;
    let sizes = |sizes: &[(&'static str, f64)]| {
        let sizes = sizes.iter().map(|(id, size)| format!("{id} {size:.4}"));
        sizes.collect::<Vec<_>>().join(", ")
    };
    let added = adopted.model.effects.iter().map(|added| added.effect.id());
    let hidden = adopted.posed.case.hidden.iter();
    let changes: Vec<_> = hidden.map(|hidden| (hidden.what.id, hidden.size)).collect();
    let stated = graded.answer.confidences.iter();
    let stated = stated.map(|(id, confidence)| format!("{id} ({confidence:.2})"));
    format!(
        "machine {}: {}\n  adopted: {} (error {:.2}, {:.1} s)\n  changed: {} (d {:.2})\n  answered: {}; in {:.1} s, \
         error elsewhere {:.2?}",
        adopted.foreign.seed,
        sizes(&adopted.foreign.own),
        added.collect::<Vec<_>>().join(", "),
        adopted.error,
        adopted.seconds,
        sizes(&changes),
        adopted.posed.detectability,
        stated.collect::<Vec<_>>().join(", "),
        graded.seconds,
        error,
    )
}

fn show_foreign(machines: &[Machine], family: Family, plan: Plan) {
    println!("\n## Foreign machines, {family:?} rig, {plan:?} plan\n");
    let all = Tally(machines.iter().map(|machine| &machine.graded).collect());
    let errors: Vec<f64> = machines.iter().map(|machine| machine.error).collect();
    let rows = [
        ("first right", all.rate(Graded::named_first).to_string()),
        ("all right", all.rate(Graded::exact).to_string()),
        (
            "wrong at confidence 0.9 or more",
            all.rate(|graded| graded.wrong_at(0.9)).to_string(),
        ),
        (
            "95 % intervals that hold the truth",
            all.coverage().to_string(),
        ),
        ("error in a third campaign, median", median(errors)),
        ("time, median", seconds(&all, 0.5)),
        ("time, 95 %", seconds(&all, 0.95)),
    ];
    println!("{}\n", table(["", NAME], rows));
    let adopting: Vec<f64> = machines
        .iter()
        .map(|machine| machine.adopted.error)
        .collect();
    let seconds: Vec<f64> = machines
        .iter()
        .map(|machine| machine.adopted.seconds)
        .collect();
    println!(
        "Adopted: error {}, in {} s (medians).\n",
        median(adopting),
        median(seconds)
    );
    show_reliability(&all);
}

/// A Markdown table of two columns.
fn table<L: Into<String>>(
    header: [&str; 2],
    rows: impl IntoIterator<Item = (L, String)>,
) -> String {
    let rows = rows.into_iter().map(|(label, cell)| [label.into(), cell]);
    markdown::table(header, &rows.collect::<Vec<_>>())
}

/// A quantile of the times as text.
fn seconds(answers: &Tally<'_>, share: f64) -> String {
    let seconds = answers.seconds(share);
    seconds.map_or("-".to_owned(), |seconds| format!("{seconds:.1} s"))
}

/// The median as text; a dash if there is none.
fn median(values: Vec<f64>) -> String {
    let middle = quantile(values.into_iter(), 0.5);
    middle.map_or("-".to_owned(), |middle| format!("{middle:.2}"))
}

fn show(arguments: &Arguments, answers: &[Graded], family: Family, plan: Plan) {
    let all = Tally(answers.iter().collect());
    println!("\n## {family:?} rig, {plan:?} plan\n");
    println!("{}\n", table(["", NAME], rows(&all)));
    show_reliability(&all);
    show_misses(arguments, answers, family, plan);
}

/// Reliability of the stated probabilities.
fn show_reliability(answers: &Tally<'_>) {
    let reliability = answers.reliability();
    if reliability.is_empty() {
        return;
    }
    println!("Effects that {NAME} names, by the probability that it states:\n");
    let rows = reliability.into_iter();
    let rows = rows.map(|(stated, there)| (format!("{stated:.2}"), there.to_string()));
    println!("{}\n", table(["stated, mean", "there"], rows));
}

/// Labels and cells of the table.
fn rows(all: &Tally<'_>) -> Vec<(String, String)> {
    let (one, two) = (all.of(Kind::Single), all.of(Kind::Pair));
    let (clean, outside) = (all.of(Kind::Nothing), all.of(Kind::Outside));
    let over = (BINS[1].0, f64::INFINITY);
    let held_out = all
        .filtered(|g| !g.posed.case.hidden.is_empty())
        .held_out()
        .map_or("-".to_owned(), |(before, after)| {
            format!("{before:.2} to {after:.2}")
        });
    let named_first = one.filtered(Graded::named_first);
    let mut rows = vec![
        row("one hidden: named first", one.rate(Graded::named_first)),
        row(
            "named first: alone, and at most 1.1 sigma left",
            named_first.rate(Graded::explained),
        ),
        row("one hidden: in the group", one.rate(Graded::named_in_group)),
        row("one hidden: only wrong names", one.rate(Graded::wrong)),
    ];
    rows.extend(BINS.map(|bin| {
        row(
            format!("named first, d {} to {}", bin.0, bin.1),
            one.within(bin).rate(Graded::named_first),
        )
    }));
    rows.extend([
        row("two hidden: exactly both", two.rate(Graded::exact)),
        row(
            format!("exactly both, d over {}", over.0),
            two.within(over).rate(Graded::exact),
        ),
        row(
            "nothing hidden: something named",
            clean.rate(|g| !g.answer.named.is_empty()),
        ),
        row(
            "nothing hidden: unknown claimed",
            clean.rate(|g| g.answer.unknown),
        ),
        row(
            "outside the catalogue: said so",
            outside.rate(|g| g.answer.unknown),
        ),
        row(
            format!("said so, d over {}", over.0),
            outside.within(over).rate(|g| g.answer.unknown),
        ),
        row("95 % intervals that hold the truth", all.coverage()),
        row("held-out error, medians", held_out),
        row("time, median", seconds(all, 0.5)),
        row("time, 95 %", seconds(all, 0.95)),
    ]);
    rows
}

/// A label and its cell.
fn row(label: impl Into<String>, cell: impl ToString) -> (String, String) {
    (label.into(), cell.to_string())
}

fn show_misses(arguments: &Arguments, answers: &[Graded], family: Family, plan: Plan) {
    for graded in answers {
        for missed in graded.missed_intervals() {
            println!("- interval, seed {}: {missed}", graded.posed.case.seed);
        }
    }
    let name = |what: String| what.to_lowercase();
    for graded in answers.iter().filter(|graded| !graded.good()) {
        let case = &graded.posed.case;
        let hidden: Vec<String> = case
            .hidden
            .iter()
            .map(|hidden| format!("{} {:.4} {}", hidden.what.id, hidden.size, hidden.what.unit))
            .collect();
        println!(
            "- {}{} {:?}, d {:.2}: [{}] answered {:?}{}{}",
            name(format!("{:?}", case.fidelity)),
            if case.rough { ", rough" } else { "" },
            case.kind,
            graded.posed.detectability,
            hidden.join(", "),
            graded.answer.named,
            if graded.answer.group.is_empty() {
                String::new()
            } else {
                format!(" or {:?}", graded.answer.group)
            },
            if graded.answer.unknown {
                ", something unknown left"
            } else {
                ""
            },
        );
        println!(
            "  `cargo bench -p host-tests --bench hidden_effects -- --seed {} --count 1 --family {} --plan {}{}`",
            case.seed,
            name(format!("{family:?}")),
            name(format!("{plan:?}")),
            arguments.wish.typed(),
        );
    }
}
