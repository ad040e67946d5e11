//! `hitch model new`: creates a commented model file.

use std::io;
use std::io::IsTerminal as _;
use std::path::{Path, PathBuf};

use hitch_input::source_file::SourceFile;
use hitch_model_file::Template;
use hitch_plant::{Valve, ValveCurve};

use hitch_output::error::Error;
use hitch_output::targets::Outputs;
use hitch_output::text::shell_word;
use hitch_results::base_model::data_sheet::{self, ENDS, QUESTIONS, VALVES};
use hitch_results::base_model::{flow_curve, linkage_table};

/// Arguments of `hitch model new`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch model new --out my-hitch.toml --lift-curve lift.csv\n  \
    hitch model new --set cylinder.bore_mm=80 --set relief_valve.set_pressure_bar=180 --out my-hitch.toml\n  \
    hitch model new --pump load-sensing --set cylinder.cylinders=2 --linkage-table linkage.csv --out my-hitch.toml\n\n\
    A curve is a table with a header, a current in A or mA and a flow in l/min, l/s, gpm or m3/s: current_a,flow_lpm. A measured \
    linkage has a travel and a height in mm, cm or m and an angle in degrees or rad: travel_mm,angle_deg,height_mm. \
    What is not given is as in the model named with --from. On a terminal it asks for the values of the data sheets."
)]
pub struct Args {
    /// Flow of the lift valve over current, CSV
    #[arg(long, value_name = "CSV")]
    lift_curve: Option<PathBuf>,
    /// Flow of the lowering valve over current, CSV
    #[arg(long, value_name = "CSV")]
    lower_curve: Option<PathBuf>,
    /// Measured linkage instead of its dimensions, CSV: travel of the piston, rocker angle, height of the hitch point
    #[arg(long, value_name = "CSV")]
    linkage_table: Option<PathBuf>,
    /// Kind of the pump
    #[arg(long, value_name = "KIND", value_parser = ["fixed-displacement", "load-sensing"])]
    pump: Option<String>,
    /// A constant, in the unit of its key; may be given several times
    #[arg(long = "set", value_name = "TABLE.KEY=VALUE")]
    set: Vec<String>,
    /// Source of the defaults: nominal, dynamic, or the name of a model file
    #[arg(long, value_name = "MODEL", default_value = "nominal")]
    from: String,
    /// Write the model file here; without this option, print it
    #[arg(long, value_name = "FILE.toml")]
    out: Option<PathBuf>,
    /// Use the defaults without asking
    #[arg(long)]
    yes: bool,
}

/// Runs the command.
///
/// # Errors
/// If a curve or a value is invalid, or the file cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    let curves = [&args.lift_curve, &args.lower_curve];
    let mut inputs: Vec<PathBuf> = curves.into_iter().flatten().cloned().collect();
    inputs.extend(args.linkage_table.clone());
    inputs.push(PathBuf::from(&args.from));
    let outputs = Outputs::check([args.out.as_deref()], &inputs)?;
    let name = args
        .out
        .as_deref()
        .map_or_else(|| "my-hitch".to_owned(), hitch_output::stem);
    let mut template = Template::of(&name, &hitch_model_file::named(&args.from)?);
    if let Some(kind) = &args.pump {
        template.set("pump.kind", kind).map_err(Error::Usage)?;
    }
    if let Some(path) = &args.linkage_table {
        template.set_linkage(linkage_table::of(&SourceFile::read_any(path)?)?);
    }
    for set in &args.set {
        let (name, value) = set.split_once('=').ok_or_else(|| {
            Error::Usage(format!("--set {set}: write it as --set TABLE.KEY=VALUE"))
        })?;
        template
            .set(name.trim(), value)
            .map_err(|why| Error::Usage(format!("--set {set}: {why}")))?;
    }
    for (valve, path) in Valve::BOTH.into_iter().zip(curves) {
        if let Some(path) = path {
            template.set_curve(valve, flow_curve::of(&SourceFile::read_any(path)?)?);
        }
    }
    if !args.yes && io::stdin().is_terminal() && io::stderr().is_terminal() {
        ask_all(&mut template, args)?;
    }
    let text = template.text()?;
    match &args.out {
        Some(path) => {
            hitch_output::write_file(path, text.as_bytes())?;
            outputs.say(|| told(path))
        }
        None => hitch_output::print(&text),
    }
}

fn told(path: &Path) -> String {
    format!(
        "{}: written; check it against your data sheets\n\
        next: hitch compare CAMPAIGN --model {}\n",
        path.display(),
        shell_word(path)
    )
}

/// Asks for values that were not given.
fn ask_all(template: &mut Template, args: &Args) -> Result<(), Error> {
    eprintln!("Data sheet values; Enter accepts the value in brackets.");
    let given = |name: &str| {
        args.set.iter().any(|set| set.starts_with(name))
            || (name == "pump.kind" && args.pump.is_some())
            || (name == "cylinder.stroke_mm" && args.linkage_table.is_some())
    };
    for (name, question) in QUESTIONS.iter().filter(|(name, _)| !given(name)) {
        // A machine does not have every constant.
        let Ok(default) = template.get(name) else {
            continue;
        };
        ask(question, &default, |answer| template.set(name, answer))?;
    }
    let curves = [&args.lift_curve, &args.lower_curve];
    for ((valve, title), path) in VALVES.into_iter().zip(curves) {
        if path.is_none() {
            let curve = asked_curve(template.curve(valve), title)?;
            template.set_curve(valve, curve);
        }
    }
    Ok(())
}

/// A flow curve with the shape of the default, between the opening current and the current limit.
fn asked_curve(default: &ValveCurve, title: &str) -> Result<ValveCurve, Error> {
    let mut ends = data_sheet::ends(default);
    for (end, (_, what)) in ends.iter_mut().zip(ENDS) {
        ask(
            &format!("{title}, {what}"),
            &format!("{end:.3}"),
            |answer| {
                *end = data_sheet::positive(answer)?;
                Ok(())
            },
        )?;
    }
    data_sheet::curve(default, ends).map_err(|why| Error::Usage(format!("{title}: {why}")))
}

/// Asks until the answer is valid; an empty one keeps the default.
fn ask(
    question: &str,
    default: &str,
    mut take: impl FnMut(&str) -> Result<(), String>,
) -> Result<(), Error> {
    loop {
        eprint!("{question} [{default}]: ");
        let mut line = String::new();
        let read = io::stdin().read_line(&mut line);
        if !read.is_ok_and(|bytes| bytes > 0) {
            return Err(Error::Usage(
                "stopped by the user; no file was written".to_owned(),
            ));
        }
        if line.trim().is_empty() {
            return Ok(());
        }
        match take(line.trim()) {
            Ok(()) => return Ok(()),
            Err(why) => eprintln!("{why}"),
        }
    }
}
