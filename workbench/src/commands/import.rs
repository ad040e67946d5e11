//! `hitch import`: a campaign from the files of any logger, which stay where they are.
use std::fs;
use std::io::{self, IsTerminal as _, Write as _};
use std::path::{Path, PathBuf};

use hitch_model::campaign::survey::{LogColumn, Survey};
use hitch_model::campaign::{Campaign, Run};

use super::loop_::load_kg;
use crate::error::Error;
use crate::import::manifest::{Log, path_from, quoted, text};
use crate::import::{Mapping, cuts};
use crate::output;

/// Arguments of `hitch import`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch import monday.csv --out monday --load 150 --map lift_current_a=\"Ventil Heben Strom:mA\"\n\n\
    Logs are tables (CSV of any kind), MDF (.mf4, .mdf) and a CAN bus (.log, .asc). They are read where they are: the \
    campaign's folder gets campaign.toml alone, which says under [columns] what each column is. Of a bus with a DBC, \
    which is named beside the logs, --map gives signals: lift_current_a=Message.Signal. A log of more than a minute is \
    cut into runs where the hitch rests. Loads that differ are corrected in campaign.toml, or stand in the files' names \
    (lift_150kg.csv)."
)]
pub struct Args {
    /// Logs, and the DBC of a bus
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// The campaign's folder
    #[arg(long, value_name = "CAMPAIGN")]
    out: PathBuf,
    /// What a column is, as in lift_current_a="Ventil Heben Strom:mA"; may be given several times
    #[arg(long = "map", value_name = "CHANNEL=NAME:UNIT")]
    maps: Vec<String>,
    /// Load at the hitch, kg
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = load_kg)]
    load: Option<f64>,
    /// What the valve block is bolted to
    #[arg(long, value_name = "BENCH", default_value = "hitch", value_parser = ["hitch", "flow"])]
    bench: String,
    /// Pressure at the cylinder port of a flow bench, bar
    #[arg(long, value_name = "BAR")]
    port_pressure: Option<f64>,
    /// Take what is proposed without asking
    #[arg(long)]
    yes: bool,
}

/// Runs the command.
///
/// # Errors
/// If a file can't be read, a column that is needed can't be told, or the campaign can't be written.
pub fn run(args: &Args) -> Result<(), Error> {
    output::no_stdout("--out", Some(&args.out), "a campaign is a folder")?;
    output::check_folder(&args.out)?;
    let manifest = args.out.join("campaign.toml");
    if manifest.exists() {
        let name = manifest.display();
        return Err(Error::Usage(format!(
            "{name}: is there already; name a folder that holds no campaign"
        )));
    }
    let is_dbc = |file: &&PathBuf| {
        file.extension()
            .is_some_and(|end| end.eq_ignore_ascii_case("dbc"))
    };
    let (dbcs, files): (Vec<&PathBuf>, Vec<&PathBuf>) = args.files.iter().partition(is_dbc);
    let named = named(&args.maps)?;
    let can = can(args, &dbcs, &named)?;
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
    let whole = Campaign::of_manifest(&args.out, &text(&name, can.as_deref(), &logs))?;
    for (log, run) in logs.iter_mut().zip(&whole.runs) {
        log.cuts = cuts::cuts(run);
    }
    let text = text(&name, can.as_deref(), &logs);
    let campaign = Campaign::of_manifest(&args.out, &text)?;
    fs::create_dir_all(&args.out).map_err(|source| Error::Write {
        path: args.out.clone(),
        source,
    })?;
    output::write_file(&manifest, text.as_bytes())?;
    output::print(&told(&args.out, &campaign.runs))
}

/// Splits what was given with `--map`.
fn named(maps: &[String]) -> Result<Vec<(String, String)>, Error> {
    let split = |map: &String| {
        let (channel, source) = map.split_once('=')?;
        Some((
            channel.trim().to_owned(),
            source.trim().trim_matches('"').to_owned(),
        ))
    };
    let fault = |map: &String| {
        Error::Usage(format!(
            "--map {map}: write it as --map CHANNEL=\"NAME:UNIT\""
        ))
    };
    maps.iter()
        .map(|map| split(map).ok_or_else(|| fault(map)))
        .collect()
}

/// `[can]` of the manifest, if a DBC is named.
fn can(
    args: &Args,
    dbcs: &[&PathBuf],
    named: &[(String, String)],
) -> Result<Option<String>, Error> {
    match dbcs {
        [] => Ok(None),
        [dbc] => {
            let dbc = path_from(&args.out, dbc);
            let signal =
                |(channel, signal): &(String, String)| format!("{channel} = {}\n", quoted(signal));
            let signals: String = named.iter().map(signal).collect();
            Ok(Some(format!(
                "\n[can]\ndbc = {}\n\n[can.signals]\n{signals}",
                quoted(&dbc)
            )))
        }
        [_, second, ..] => {
            let name = second.display();
            Err(Error::Usage(format!(
                "{name}: is a second DBC; a campaign has one"
            )))
        }
    }
}

/// What is taken of a log; asks where that is a terminal.
fn mapping(args: &Args, file: &Path, named: &[(String, String)]) -> Result<Option<Mapping>, Error> {
    let (columns, needs_time) = match Survey::of(file)? {
        Survey::Own | Survey::Bus => return Ok(None),
        Survey::Table(columns) => (columns, true),
        Survey::Channels(columns) => (columns, false),
    };
    let asks = !args.yes && io::stdin().is_terminal() && io::stdout().is_terminal();
    let mut named = named.to_vec();
    loop {
        let proposal = Mapping::propose(&columns, needs_time, &named)
            .map_err(|why| format!("{}: {why}", file.display()));
        match &proposal {
            Ok(mapping) => output::print(&shown(file, &columns, mapping))?,
            Err(why) if asks => output::print(&format!("{why}\n"))?,
            Err(why) => return Err(Error::Usage(why.clone())),
        }
        let answer = if asks { answer()? } else { String::new() };
        match (answer.trim(), proposal) {
            ("", Ok(mapping)) => return Ok(Some(mapping)),
            ("q" | "", _) => return Err(Error::Usage("stopped; nothing was written".to_owned())),
            (answer, _) => {
                let mut more = self::named(&[answer.to_owned()])?;
                named.retain(|(channel, _)| *channel != more[0].0);
                named.append(&mut more);
            }
        }
    }
}

fn answer() -> Result<String, Error> {
    print!("Enter takes this, CHANNEL=NAME:UNIT changes a line, q stops: ");
    io::stdout().flush().map_err(Error::Stdout)?;
    let mut line = String::new();
    match io::stdin().read_line(&mut line) {
        Ok(0) => Ok("q".to_owned()),
        Ok(_) => Ok(line),
        Err(error) => Err(Error::Usage(format!("the answer can't be read: {error}"))),
    }
}

/// The proposal as a table.
fn shown(file: &Path, columns: &[LogColumn], mapping: &Mapping) -> String {
    let mut text = format!("{}:\n", file.display());
    let width = mapping
        .taken
        .iter()
        .map(|taken| taken.source.chars().count())
        .max()
        .unwrap_or(0);
    for taken in &mapping.taken {
        text += &format!(
            "  {:<22} {:<width$}  {}\n",
            taken.channel, taken.source, taken.reason
        );
    }
    let others = columns.len().saturating_sub(mapping.taken.len());
    text + &format!("  {others} other columns are passed over\n")
}

/// The lines of a run that say what the valve block was bolted to.
fn bench(args: &Args, file: &Path) -> Result<String, Error> {
    if args.bench == "flow" {
        let pressure = args.port_pressure.ok_or_else(|| {
            Error::Usage(
                "a flow bench has a pressure at its port; give it with --port-pressure BAR"
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
            "{name}: the load at the hitch isn't known; give it with --load KG"
        ))
    })?;
    Ok(format!("bench = \"hitch\"\nload_kg = {load}\n"))
}

/// `lift_150kg` is with 150 kg.
fn load_in_name(name: &str) -> Option<f64> {
    let lower = name.to_ascii_lowercase();
    let before = lower.split_once("kg")?.0.trim_end_matches([' ', '_']);
    let digits = before
        .rfind(|c: char| !c.is_ascii_digit() && c != '.')
        .map_or(0, |last| last + 1);
    load_kg(before.get(digits..)?).ok()
}

fn told(out: &Path, runs: &[Run]) -> String {
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
        "{}: written; next: hitch compare {}\n",
        out.join("campaign.toml").display(),
        out.display()
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
