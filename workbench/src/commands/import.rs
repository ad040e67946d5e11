//! `hitch import`: creates a campaign from the files of any logger, which are read in place.

use std::fs;
use std::path::{Path, PathBuf};

use hitch_campaign::survey::{LogColumn, Survey};
use hitch_campaign::{Campaign, Run, survey};
use hitch_model_file::quoted;

use super::loop_::load_kg;
use crate::error::Error;
use crate::import::manifest::{Log, lines, path_from, text};
use crate::import::{Kind, Mapping, cuts, dialogue};
use crate::model_arg::ModelArg;
use crate::output;

/// Arguments of `hitch import`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch import monday.csv --out monday --load 150 --map lift_current_a=\"Ventil Heben Strom:mA\"\n\n\
    Logs are tables (CSV of any dialect), MDF (.mf4, .mdf) or recordings of a CAN bus (.log, .asc). They are read in \
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
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = load_kg)]
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
    output::no_stdout("--out", Some(&args.out), "a campaign is a folder")?;
    output::check_folder(&args.out)?;
    let manifest = args.out.join("campaign.toml");
    if manifest.exists() {
        let name = manifest.display();
        return Err(Error::Usage(format!(
            "{name}: exists already; give a folder without a campaign"
        )));
    }
    let is_dbc = |file: &&PathBuf| {
        file.extension()
            .is_some_and(|end| end.eq_ignore_ascii_case("dbc"))
    };
    let (dbcs, files): (Vec<&PathBuf>, Vec<&PathBuf>) = args.files.iter().partition(is_dbc);
    let model = args.model.load()?;
    let named = dialogue::named(&args.maps)?;
    let can = can(args, &dbcs, &files, &named)?;
    let mut logs = Vec::with_capacity(files.len());
    for file in files {
        let mapping = mapping(args, file, &named)?;
        logs.push(Log {
            file: path_from(&args.out, file),
            mapping,
            bench: bench(args, file)?,
            cuts: Vec::new(),
        });
    }
    let name = args
        .out
        .file_name()
        .unwrap_or(args.out.as_os_str())
        .to_string_lossy()
        .into_owned();
    let whole = Campaign::of_manifest(
        &args.out,
        &text(&name, can.as_deref(), &logs),
        model.linkage(),
    )?;
    for (log, run) in logs.iter_mut().zip(&whole.runs) {
        log.cuts = cuts::cuts(run);
    }
    let text = text(&name, can.as_deref(), &logs);
    let campaign = Campaign::of_manifest(&args.out, &text, model.linkage())?;
    fs::create_dir_all(&args.out).map_err(|source| Error::Write {
        path: args.out.clone(),
        source,
    })?;
    output::write_file(&manifest, text.as_bytes())?;
    output::print(&told(args, &campaign.runs))
}

/// `[can]` of the manifest, if a DBC file is given.
fn can(
    args: &Args,
    dbcs: &[&PathBuf],
    files: &[&PathBuf],
    named: &[(String, String)],
) -> Result<Option<String>, Error> {
    let dbc = match dbcs {
        [] => return Ok(None),
        [dbc] => *dbc,
        [_, second, ..] => {
            let name = second.display();
            return Err(Error::Usage(format!(
                "{name}: is a second DBC file; a campaign has one"
            )));
        }
    };
    let mut columns: Vec<LogColumn> = Vec::new();
    let mut unknown_frames = 0;
    for file in files.iter().filter(|file| survey::is_bus(file)) {
        let found = survey::bus_signals(file, dbc)?;
        unknown_frames += found.unknown_frames;
        for column in found.columns {
            let is_new = columns.iter().all(|known| known.name != column.name);
            columns.extend(is_new.then_some(column));
        }
    }
    if columns.is_empty() {
        let name = dbc.display();
        return Err(Error::Usage(format!(
            "{name}: describes a bus, but no log of a bus (.log, .asc) is given"
        )));
    }
    let heading = match unknown_frames {
        0 => dbc.display().to_string(),
        frames => format!(
            "{} ({frames} frames of messages that it does not define are ignored)",
            dbc.display()
        ),
    };
    let mapping = dialogue::agreed(&heading, &columns, Kind::Signals, named, !args.yes)?;
    Ok(Some(format!(
        "\n[can]\ndbc = {}\n\n[can.signals]\n{}",
        quoted(&path_from(&args.out, dbc)),
        lines(&mapping)
    )))
}

/// The column assignment of a log; `None` if the default applies.
fn mapping(args: &Args, file: &Path, named: &[(String, String)]) -> Result<Option<Mapping>, Error> {
    let (columns, kind) = match Survey::of(file)? {
        Survey::Own | Survey::Bus => return Ok(None),
        Survey::Table(columns) => (columns, Kind::Table),
        Survey::Channels(columns) => (columns, Kind::Channels),
    };
    let heading = file.display().to_string();
    dialogue::agreed(&heading, &columns, kind, named, !args.yes).map(Some)
}

/// The lines of a run that describe its bench.
fn bench(args: &Args, file: &Path) -> Result<String, Error> {
    if args.bench == "flow" {
        let pressure = args.port_pressure.ok_or_else(|| {
            Error::Usage(
                "the port pressure of the flow bench is missing; give it with --port-pressure BAR"
                    .to_owned(),
            )
        })?;
        return Ok(format!(
            "bench = \"flow\"\nport_pressure_bar = {pressure}\n"
        ));
    }
    let named = || load_in_name(&file.file_stem().unwrap_or_default().to_string_lossy());
    let load = args.load.or_else(named).ok_or_else(|| {
        let name = file.display();
        Error::Usage(format!(
            "{name}: the load at the hitch is missing; give it with --load KG"
        ))
    })?;
    Ok(format!("bench = \"hitch\"\nload_kg = {load}\n"))
}

/// The load in a file name: 150 kg in `lift_150kg`.
fn load_in_name(name: &str) -> Option<f64> {
    let lower = name.to_ascii_lowercase();
    let before = lower.split_once("kg")?.0.trim_end_matches([' ', '_']);
    let digits = before
        .rfind(|c: char| !c.is_ascii_digit() && c != '.')
        .map_or(0, |last| last + 1);
    load_kg(before.get(digits..)?).ok()
}

fn told(args: &Args, runs: &[Run]) -> String {
    let mut text = String::new();
    for run in runs {
        let seconds = run.duration_s();
        text += &format!(
            "run {}: {} samples, {seconds:.1} s\n",
            run.file,
            run.time_s.len()
        );
    }
    text + &format!(
        "{}: written; next: hitch compare {}{}\n",
        args.out.join("campaign.toml").display(),
        args.out.display(),
        args.model.written()
    )
}

#[cfg(test)]
mod tests {
    use super::load_in_name;

    #[test]
    fn loads_stand_in_names() {
        assert_eq!(load_in_name("lift_1.5A_050kg"), Some(50.0));
        assert_eq!(load_in_name("150 kg heben"), Some(150.0));
        assert_eq!(load_in_name("monday"), None);
        assert_eq!(load_in_name("kg"), None);
    }
}
