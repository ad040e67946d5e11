//! `hitch import`: creates a campaign from the files of any logger, which are read in place.

use std::path::{Path, PathBuf};

use hitch_campaign::{Bench, Run};
use hitch_measurement::check;

use hitch_output::error::Error;
use hitch_output::text::{shell_word, wrapped};
use hitch_results::arguments::model::ModelArg;
use hitch_results::arguments::number::{LOADS_KG, number};
use hitch_results::import::files::columns;
use hitch_results::import::manifest::{Log, campaign, path_from};
use hitch_results::import::{Columns, Files, dialogue, loads_in_name};
use hitch_results::measurement;

/// Arguments of `hitch import`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch import monday.csv --out monday --load 150 --map lift_current_a=\"Ventil Heben Strom:mA\"\n\n\
    Logs are tables (CSV of any dialect, .parquet), MDF (.mf4, .mdf), MAT files of MATLAB up to -v7 (.mat: vectors, \
    structs, time series as structs with Time and Data), or recordings of a CAN bus (.log, .asc, .blf). They are read in \
    place: only campaign.toml is written to the campaign's folder, with the assignment of columns in [columns]. For a \
    bus, give its DBC file together with the logs, and assign signals with --map lift_current_a=Message.Signal. An \
    angle in mm is the travel of the cylinder; the linkage of --model converts it into an angle. A log of more than a \
    minute is split into runs where the hitch is at rest. Different loads are entered in campaign.toml, or taken from \
    the file names (lift_150kg.csv)."
)]
pub struct Args {
    /// Logs, and the DBC file of a bus
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Folder of the campaign
    #[arg(long, value_name = "CAMPAIGN")]
    out: PathBuf,
    /// Assign a column, as in lift_current_a="Ventil Heben Strom:mA"; may be given several times
    #[arg(long = "map", value_name = "CHANNEL=NAME:UNIT")]
    maps: Vec<String>,
    /// Load at the hitch, kg
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = number(LOADS_KG))]
    load: Option<f64>,
    /// Bench that the valve block is connected to
    #[arg(long, value_name = "BENCH", default_value = "hitch", value_parser = ["hitch", "flow"])]
    bench: String,
    /// Pressure at the cylinder port of a flow bench, bar
    #[arg(long, value_name = "BAR")]
    port_pressure: Option<f64>,
    #[command(flatten)]
    model: ModelArg,
    /// Accept the proposal without asking
    #[arg(long)]
    yes: bool,
}

/// Runs the command.
///
/// # Errors
/// If a file cannot be read, a required column cannot be determined, or the campaign cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    hitch_output::no_stdout("--out", Some(&args.out), "a campaign is a folder")?;
    hitch_output::check_folder(&args.out)?;
    let manifest = args.out.join("campaign.toml");
    if manifest.exists() {
        let name = manifest.display();
        return Err(Error::Usage(format!(
            "{name}: exists already; give a folder without a campaign"
        )));
    }
    let mut files = Files::sort(&args.files)?;
    let model = args.model.load()?;
    let named = dialogue::named(&args.maps)?;
    let agreed = |found: Option<Columns>| {
        let agreed = |found: Columns| dialogue::agreed(&found, &named, !args.yes);
        found.map(agreed).transpose()
    };
    let signals = agreed(files.signals()?)?;
    let mut logs = Vec::with_capacity(files.logs.len());
    for file in &files.logs {
        logs.push(Log {
            file: path_from(&args.out, file),
            mapping: agreed(columns(file)?)?,
            bench: bench(args, file)?,
            then: Vec::new(),
            cuts: Vec::new(),
        });
    }
    let name = args.out.file_name().unwrap_or(args.out.as_os_str());
    let (text, campaign, notes) = campaign(
        &args.out,
        &name.to_string_lossy(),
        files.can(&args.out, signals.as_ref()).as_deref(),
        logs,
        model.linkage(),
    )?;
    hitch_output::create_folder(&args.out)?;
    hitch_output::write_file(&manifest, text.as_bytes())?;
    let faults = measurement::text(&check(&campaign, Some(&model)));
    hitch_output::print(&(faults + &told(args, &notes, &campaign.runs)))
}

/// The test stand of a log.
fn bench(args: &Args, file: &Path) -> Result<Bench, Error> {
    if args.bench == "flow" {
        let missing = || {
            let what =
                "the port pressure of the flow bench is missing; give it with --port-pressure BAR";
            Error::Usage(what.to_owned())
        };
        let port_pressure_bar = args.port_pressure.ok_or_else(missing)?;
        return Ok(Bench::Flow { port_pressure_bar });
    }
    if let Some(load_kg) = args.load {
        return Ok(Bench::Hitch { load_kg });
    }
    let wrong = |what: &str| {
        let name = file.display();
        Error::Usage(format!("{name}: {what}; give it with --load KG"))
    };
    match loads_in_name(file)[..] {
        [load_kg] => Ok(Bench::Hitch { load_kg }),
        [] => Err(wrong("the load at the hitch is missing")),
        [first, second, ..] => {
            let both = format!("its name has the loads {first} kg and {second} kg");
            Err(wrong(&both))
        }
    }
}

fn told(args: &Args, notes: &[String], runs: &[Run]) -> String {
    let mut text: String = notes.iter().map(|note| wrapped(note) + "\n").collect();
    for run in runs {
        let seconds = run.duration_s();
        let load = match run.bench {
            Bench::Hitch { load_kg } if args.load.is_some() => format!(", {load_kg} kg as given"),
            Bench::Hitch { load_kg } => format!(", {load_kg} kg by its name"),
            Bench::Flow { .. } => String::new(),
        };
        let run = format!(
            "run {}: {} samples, {seconds:.1} s{load}",
            run.file,
            run.time_s.len()
        );
        text += &(wrapped(&run) + "\n");
    }
    text + &format!(
        "{}: written\nnext: hitch compare {}{}\n",
        args.out.join("campaign.toml").display(),
        shell_word(&args.out),
        args.model.written()
    )
}
