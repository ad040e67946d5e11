//! Detection rates of hidden effects: cases of the second rig, answered by `hitch explain` and by established methods.
//!
//! ```text
//! cargo bench -p host-tests --bench hidden_effects -- --count 40 --family steady --plan lab
//! cargo bench -p host-tests --bench hidden_effects -- --count 40 --family steady --plan lab --foreign
//! ```
//!
//! Prints a Markdown table for each family and plan, and every failure of the project's own method with the command
//! that repeats it. The rig shares no equation with the fitted model.

use clap::Parser;
use comfy_table::{Table, presets};
use host_tests::hidden_effects::answer::Method;
use host_tests::hidden_effects::foreign::Adopted;
use host_tests::hidden_effects::grade::{Graded, Posed};
use host_tests::hidden_effects::tally::{BINS, Tally, quantile};
use host_tests::hidden_effects::wrong_base::declared_within;
use host_tests::hidden_effects::{methods, starting_point};
use host_tests::second_rig::draw::{Kind, draw};
use host_tests::second_rig::manoeuvres::Plan;
use host_tests::second_rig::test_stand::Family;
use host_tests::second_rig::wish_arguments::WishArguments;
use indicatif::{ProgressBar, ProgressStyle};

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
    /// Methods, by a part of their name
    #[arg(long, value_delimiter = ',')]
    methods: Vec<String>,
    /// Given by cargo
    #[arg(long, hide = true)]
    bench: bool,
}

impl Arguments {
    fn chosen_methods(&self) -> Vec<Box<dyn Method>> {
        let wanted = |name: &str| {
            let name = name.to_lowercase();
            self.methods.is_empty()
                || self
                    .methods
                    .iter()
                    .any(|part| name.contains(&part.to_lowercase()))
        };
        methods()
            .into_iter()
            .filter(|method| wanted(method.name()))
            .collect()
    }
}

fn main() {
    let arguments = Arguments::parse();
    let methods = arguments.chosen_methods();
    let groups = arguments.family.len() * arguments.plan.len() * methods.len();
    let bar = ProgressBar::new(groups as u64 * arguments.count).with_style(
        ProgressStyle::with_template("{bar:30} {pos}/{len} {elapsed} {msg}")
            .expect("a sound template"),
    );
    for &family in &arguments.family {
        for &plan in &arguments.plan {
            if arguments.foreign {
                let machines = foreign_machines(&arguments, &methods, family, plan, &bar);
                bar.suspend(|| show_foreign(&methods, &machines, family, plan));
                continue;
            }
            let answers = answers(&arguments, &methods, family, plan, &bar);
            bar.suspend(|| show(&arguments, &methods, &answers, family, plan));
        }
    }
    bar.finish_and_clear();
}

/// Answers of every method, in the methods' order.
fn answers(
    arguments: &Arguments,
    methods: &[Box<dyn Method>],
    family: Family,
    plan: Plan,
    bar: &ProgressBar,
) -> Vec<Vec<Graded>> {
    let mut answers: Vec<Vec<Graded>> = methods.iter().map(|_| Vec::new()).collect();
    for seed in arguments.seed..arguments.seed + arguments.count {
        let posed = Posed::new(draw(seed, &arguments.wish.wish(family, plan)));
        let declared = match arguments.wrong_base {
            true => declared_within(family, seed, arguments.base_error),
            false => starting_point(family),
        };
        for (method, answers) in methods.iter().zip(&mut answers) {
            bar.set_message(format!("{family:?} {plan:?} {seed} {}", method.name()));
            let graded = posed.ask_about(method.as_ref(), &declared);
            bar.inc(1);
            let verdict = if graded.good() { "good" } else { "miss" };
            let line = format!(
                "{family:?} {plan:?} {seed} {}: {verdict}, {:.2?} in {:.1} s",
                method.name(),
                graded.answer.confidences,
                graded.seconds
            );
            bar.suspend(|| eprintln!("{line}"));
            answers.push(graded);
        }
    }
    answers
}

/// A foreign machine with every method's answer, in the methods' order.
struct Machine {
    adopted: Adopted,
    answers: Vec<Graded>,
    /// Error in a third campaign of the model that each method found, in sigmas.
    errors: Vec<Option<f64>>,
}

fn foreign_machines(
    arguments: &Arguments,
    methods: &[Box<dyn Method>],
    family: Family,
    plan: Plan,
    bar: &ProgressBar,
) -> Vec<Machine> {
    let seeds = arguments.seed..arguments.seed + arguments.count;
    let machines = seeds.map(|seed| {
        bar.set_message(format!("{family:?} {plan:?} {seed}"));
        let adopted = Adopted::new(seed, family, plan);
        let answers: Vec<Graded> = methods
            .iter()
            .map(|method| adopted.ask(method.as_ref()))
            .collect();
        bar.inc(methods.len() as u64);
        let errors = answers
            .iter()
            .map(|graded| Some(adopted.error_elsewhere(graded.answer.model.as_ref()?)));
        let errors: Vec<Option<f64>> = errors.collect();
        let line = told(&adopted, &answers, &errors);
        bar.suspend(|| eprintln!("{line}"));
        Machine {
            adopted,
            answers,
            errors,
        }
    });
    machines.collect()
}

/// A machine and the answer of the first method, as text.
fn told(adopted: &Adopted, answers: &[Graded], errors: &[Option<f64>]) -> String {
    let sizes = |sizes: &[(&'static str, f64)]| {
        let sizes = sizes.iter().map(|(id, size)| format!("{id} {size:.4}"));
        sizes.collect::<Vec<_>>().join(", ")
    };
    let added = adopted.model.effects.iter().map(|added| added.effect.id());
    let hidden = adopted.posed.case.hidden.iter();
    let changes: Vec<_> = hidden.map(|hidden| (hidden.what.id, hidden.size)).collect();
    let stated = answers.iter().map(|graded| {
        let confidences = graded.answer.confidences.iter();
        let stated = confidences.map(|(id, confidence)| format!("{id} ({confidence:.2})"));
        stated.collect::<Vec<_>>().join(", ")
    });
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
        stated.collect::<Vec<_>>().join(" | "),
        answers.first().map_or(0.0, |graded| graded.seconds),
        errors.first().copied().flatten().unwrap_or(f64::NAN),
    )
}

fn show_foreign(methods: &[Box<dyn Method>], machines: &[Machine], family: Family, plan: Plan) {
    println!("\n## Foreign machines, {family:?} rig, {plan:?} plan\n");
    let mut table = Table::new();
    table.load_preset(presets::ASCII_MARKDOWN);
    table.set_header(std::iter::once("").chain(methods.iter().map(|method| method.name())));
    let columns: Vec<Vec<(&str, String)>> = (0..methods.len())
        .map(|method| foreign_column(machines, method))
        .collect();
    for row in 0..columns.first().map_or(0, Vec::len) {
        let cells = columns.iter().map(|column| column[row].1.clone());
        table.add_row(std::iter::once(columns[0][row].0.to_owned()).chain(cells));
    }
    println!("{table}\n");
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
    for (index, method) in methods.iter().enumerate() {
        let answers: Vec<Graded> = machines
            .iter()
            .map(|machine| machine.answers[index].clone())
            .collect();
        show_reliability(method.as_ref(), &answers);
    }
}

/// Labels and cells of a method's column for foreign machines.
fn foreign_column(machines: &[Machine], method: usize) -> Vec<(&'static str, String)> {
    let answers = machines.iter().map(|machine| &machine.answers[method]);
    let all = Tally(answers.collect());
    let errors: Vec<f64> = machines
        .iter()
        .filter_map(|machine| machine.errors[method])
        .collect();
    let seconds = |share| {
        all.seconds(share)
            .map_or("-".to_owned(), |s| format!("{s:.1} s"))
    };
    vec![
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
        ("time, median", seconds(0.5)),
        ("time, 95 %", seconds(0.95)),
    ]
}

/// The median as text; a dash if there is none.
fn median(values: Vec<f64>) -> String {
    let middle = quantile(values.into_iter(), 0.5);
    middle.map_or("-".to_owned(), |middle| format!("{middle:.2}"))
}

fn show(
    arguments: &Arguments,
    methods: &[Box<dyn Method>],
    answers: &[Vec<Graded>],
    family: Family,
    plan: Plan,
) {
    println!("\n## {family:?} rig, {plan:?} plan\n");
    println!("{}\n", table(methods, answers));
    for (method, answers) in methods.iter().zip(answers) {
        show_reliability(method.as_ref(), answers);
        if method.abilities().unknown {
            show_misses(arguments, answers, family, plan);
        }
    }
}

/// Reliability of the stated probabilities.
fn show_reliability(method: &dyn Method, answers: &[Graded]) {
    let reliability = Tally(answers.iter().collect()).reliability();
    if reliability.is_empty() {
        return;
    }
    println!(
        "Effects that {} names, by the probability that it states:\n",
        method.name()
    );
    let mut table = Table::new();
    table.load_preset(presets::ASCII_MARKDOWN);
    table.set_header(["stated, mean", "there"]);
    for (stated, there) in reliability {
        table.add_row([format!("{stated:.2}"), there.to_string()]);
    }
    println!("{table}\n");
}

fn table(methods: &[Box<dyn Method>], answers: &[Vec<Graded>]) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::ASCII_MARKDOWN);
    let names = methods.iter().map(|method| method.name());
    table.set_header(std::iter::once("").chain(names));
    let columns: Vec<Vec<(String, String)>> = methods
        .iter()
        .zip(answers)
        .map(|(method, answers)| column(method.as_ref(), &Tally(answers.iter().collect())))
        .collect();
    for row in 0..columns[0].len() {
        let cells = columns.iter().map(|column| column[row].1.clone());
        table.add_row(std::iter::once(columns[0][row].0.clone()).chain(cells));
    }
    table
}

/// Labels and cells of a method's column.
fn column(method: &dyn Method, all: &Tally) -> Vec<(String, String)> {
    let able = method.abilities();
    let cannot = |can: bool, cell: String| if can { cell } else { "cannot".to_owned() };
    let one = all.of(Kind::Single);
    let two = all.of(Kind::Pair);
    let clean = all.of(Kind::Nothing);
    let mut rows = vec![
        (
            "one hidden: named first".to_owned(),
            cannot(able.names, one.rate(Graded::named_first).to_string()),
        ),
        (
            "named first: alone, and at most 1.1 sigma left".to_owned(),
            cannot(
                able.intervals,
                one.filtered(Graded::named_first)
                    .rate(Graded::explained)
                    .to_string(),
            ),
        ),
        (
            "one hidden: in the group".to_owned(),
            cannot(able.names, one.rate(Graded::named_in_group).to_string()),
        ),
        (
            "one hidden: only wrong names".to_owned(),
            cannot(able.names, one.rate(Graded::wrong).to_string()),
        ),
    ];
    for bin in BINS {
        rows.push((
            format!("named first, d {} to {}", bin.0, bin.1),
            cannot(
                able.names,
                one.within(bin).rate(Graded::named_first).to_string(),
            ),
        ));
    }
    rows.push((
        "two hidden: exactly both".to_owned(),
        cannot(able.names, two.rate(Graded::exact).to_string()),
    ));
    let visible = two.within((BINS[1].0, f64::INFINITY));
    rows.push((
        format!("exactly both, d over {}", BINS[1].0),
        cannot(able.names, visible.rate(Graded::exact).to_string()),
    ));
    rows.push((
        "nothing hidden: something named".to_owned(),
        cannot(
            able.names,
            clean.rate(|g| !g.answer.named.is_empty()).to_string(),
        ),
    ));
    rows.push((
        "nothing hidden: unknown claimed".to_owned(),
        cannot(able.unknown, clean.rate(|g| g.answer.unknown).to_string()),
    ));
    rows.extend(column_of_measures(method, all));
    rows
}

/// The rest of a column.
fn column_of_measures(method: &dyn Method, all: &Tally) -> Vec<(String, String)> {
    let able = method.abilities();
    let cannot = |can: bool, cell: String| if can { cell } else { "cannot".to_owned() };
    let outside = all.of(Kind::Outside);
    let held_out = all
        .filtered(|g| !g.posed.case.hidden.is_empty())
        .held_out()
        .map_or("-".to_owned(), |(before, after)| {
            format!("{before:.2} to {after:.2}")
        });
    let seconds = |share| {
        all.seconds(share)
            .map_or("-".to_owned(), |s| format!("{s:.1} s"))
    };
    vec![
        (
            "outside the catalogue: said so".to_owned(),
            cannot(able.unknown, outside.rate(|g| g.answer.unknown).to_string()),
        ),
        (
            "said so, d over 0.25".to_owned(),
            cannot(
                able.unknown,
                outside
                    .within((BINS[1].0, f64::INFINITY))
                    .rate(|g| g.answer.unknown)
                    .to_string(),
            ),
        ),
        (
            "95 % intervals that hold the truth".to_owned(),
            cannot(able.intervals, all.coverage().to_string()),
        ),
        ("held-out error, medians".to_owned(), held_out),
        ("time, median".to_owned(), seconds(0.5)),
        ("time, 95 %".to_owned(), seconds(0.95)),
    ]
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
