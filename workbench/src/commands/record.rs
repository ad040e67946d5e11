//! `hitch record`: records a campaign from a running ECU, over XCP.
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use hitch_campaign::{Bench, Run};

use hitch_ecu_host::xcp_tool::{
    BusAddress, CHANNELS, PERIOD_MS, Recording, Row, connect, record, tool_error,
};
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_output::text::{joined, wrapped};
use hitch_results::arguments::number::{LOADS_KG, OIL_C, number};
use hitch_results::import::run_block::RunBlock;

/// Arguments of `hitch record`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: hitch record --can 127.0.0.1:7701 --load 150 --temperature 40 --seconds 30 --out campaign\n\n\
    Records currents, pressures and rocker angle at 100 Hz. The hitch has to be at rest at the start. A run is added to an \
    existing campaign, so that it can cover several loads. `hitch explain` reads the campaign."
)]
pub struct Args {
    /// The ECU's bus: HOST:PORT of an slcan adapter such as `hitch ecu --can`, a CAN interface of Linux (can0), or the serial
    /// port of an slcan adapter (/dev/ttyACM0, COM3)
    #[arg(long, value_name = "BUS")]
    can: BusAddress,
    /// Folder of the campaign
    #[arg(long, value_name = "CAMPAIGN")]
    out: PathBuf,
    /// Load at the hitch, kg
    #[arg(long, value_name = "KG", allow_negative_numbers = true, value_parser = number(LOADS_KG))]
    load: f64,
    /// Oil temperature, C
    #[arg(long, value_name = "C", allow_negative_numbers = true, value_parser = number(OIL_C))]
    temperature: f64,
    /// Duration, s
    #[arg(long, value_name = "S", default_value = "30", value_parser = number(0.1..=3_600.0))]
    seconds: f64,
}

/// Runs the command.
///
/// # Errors
/// If the ECU cannot be reached, the connection is lost, or the campaign cannot be written. What was recorded until a loss
/// is kept.
pub fn run(args: &Args) -> Result<(), Error> {
    let manifest = args.out.join("campaign.toml");
    hitch_output::no_stdout("--out", Some(&args.out), "a campaign is a folder")?;
    hitch_output::check_folder(&args.out)?;
    let so_far = so_far(args, &manifest)?;
    let progress = Progress::start("recording");
    let mut session = connect(&args.can)?;
    let Recording { rows, lost } = record(&mut session, args.seconds, |time_s| {
        progress.say(format!("recording: {time_s:.1} s"));
    })
    .map_err(tool_error)?;
    // A connection that is lost has nothing to close.
    let lost = lost.or(session.close().err());
    drop(progress);
    if let Some(fault) = lost.as_ref().filter(|_| rows.len() < Run::FEWEST_SAMPLES) {
        return Err(Error::Usage(format!(
            "{fault}; too few samples until then to keep"
        )));
    }
    hitch_output::create_folder(&args.out)?;
    let names = (1..).map(|number| format!("run_{number:02}.csv"));
    let file = hitch_output::first_free(names, |name| args.out.join(name).exists());
    hitch_output::write_file(&args.out.join(&file), log(&rows).as_bytes())?;
    let run = RunBlock {
        file: &file,
        then: &[],
        bench: Bench::Hitch { load_kg: args.load },
        oil_temperature_c: Some(args.temperature),
        span_s: None,
    };
    hitch_output::write_file(&manifest, format!("{so_far}{run}").as_bytes())?;
    let kept = format!("{} samples of {file} in {}", rows.len(), args.out.display());
    match lost {
        None => hitch_output::print(&(wrapped(&kept) + "\n")),
        Some(fault) => Err(Error::Usage(format!(
            "{fault}; what was recorded until then is kept: {kept}"
        ))),
    }
}

/// The existing manifest of the campaign, or the head of a new one.
fn so_far(args: &Args, manifest: &Path) -> Result<String, Error> {
    if manifest.exists() {
        return fs::read_to_string(manifest).map_err(|error| {
            Error::Usage(format!("{}: cannot be read: {error}", manifest.display()))
        });
    }
    let name = args.out.file_name().unwrap_or(args.out.as_os_str());
    let name = name.to_string_lossy().replace(['"', '\\'], "");
    Ok(format!(
        "format = 1\nname = \"{name}\"\ndescription = \"Recorded from the ECU over XCP\"\nsample_rate_hz = {}\n",
        1_000 / PERIOD_MS
    ))
}

fn log(rows: &[Row]) -> String {
    let names: Vec<&str> = CHANNELS.iter().map(|(column, _)| *column).collect();
    let mut text = format!("time_s,{}\n", names.join(","));
    for (time_s, values) in rows {
        let values = values.iter().map(|value| format!("{value:.3}"));
        // Writing to a string can't fail.
        let _ = writeln!(text, "{time_s:.3},{}", joined(values, ","));
    }
    text
}
