//! `campaign.toml`: the runs and their metadata.

use std::path::{Path, PathBuf};

use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;
use hitch_input::toml_reader::TomlTable;
use hitch_plant::{Channel, Linkage};

use crate::bus_log::BusSettings;
use crate::columns::ColumnSettings;
use crate::cut::Cut;
use crate::folder::{file_in, file_name, folder_name, manifest_of};
use crate::recorded::{Bench, Campaign, CampaignError, Noise, Run};
use crate::run_log;
use crate::run_log::Settings;
use crate::series::median_step_s;
use crate::table::{LONGEST_STEP_S, LogNotes, Table};

/// Key of the files in which a recording continues.
const THEN: &str = "then";
/// Range of loads that the cylinder can hold below the relief pressure, with a margin, kg.
const LOAD_KG: std::ops::RangeInclusive<f64> = 0.0..=20_000.0;
/// Range of pressures of hydraulics of this class, bar.
const PORT_PRESSURE_BAR: std::ops::RangeInclusive<f64> = 0.0..=400.0;
/// Range of oil temperatures, degrees Celsius: limited by the oil's pour point and the seals.
const OIL_TEMPERATURE_C: std::ops::RangeInclusive<f64> = -40.0..=150.0;
/// Range of sample rates, Hz: from slower than the hitch moves to faster than any logger of this class.
const SAMPLE_RATE_HZ: std::ops::RangeInclusive<f64> = 0.5..=100_000.0;
/// Range of a standard deviation, in any instrument's unit. Zero is not allowed: without the key it is estimated.
const SIGMA: std::ops::RangeInclusive<f64> = 1e-6..=100.0;

/// Reads the folder of a campaign with a hitch of this linkage.
pub fn load(dir: &Path, linkage: &Linkage) -> Result<Campaign, CampaignError> {
    let source = manifest_of(dir)?;
    read(dir, &source, linkage, LONGEST_STEP_S).map(|(campaign, _)| campaign)
}

/// The logs and the DBC that the manifest in a folder refers to, in any folder.
pub fn files(dir: &Path) -> Result<Vec<PathBuf>, CampaignError> {
    let source = SourceFile::read(&dir.join("campaign.toml"))?;
    let top = TomlTable::parse(&source)?;
    let mut files = Vec::new();
    for run in top.tables("run")? {
        files.extend(run.text("file")?.map(|file| dir.join(file)));
        let then = run.texts(THEN)?.unwrap_or_default();
        files.extend(then.into_iter().map(|file| dir.join(file)));
    }
    if let Some(can) = top.table("can")? {
        files.extend(can.text("dbc")?.map(|file| dir.join(file)));
    }
    Ok(files)
}

/// Reads the campaign of a manifest located in `dir`, whose samples are at most `longest_step_s` apart; and the log of each
/// run.
pub fn read(
    dir: &Path,
    source: &SourceFile,
    linkage: &Linkage,
    longest_step_s: f64,
) -> Result<(Campaign, Vec<LogNotes>), CampaignError> {
    let top = TomlTable::parse(source)?;
    top.check_format()?;
    top.only(&[
        "format",
        "name",
        "description",
        "sample_rate_hz",
        "clocks",
        "noise",
        "can",
        "columns",
        "run",
    ])?;
    let noise = noise(&top)?;
    let synchronous = synchronous(&top)?;
    let declared_rate_hz = top.number("sample_rate_hz", SAMPLE_RATE_HZ)?;
    let name = top
        .text("name")?
        .map_or_else(|| folder_name(dir), str::to_owned);
    let description = top.text("description")?.unwrap_or_default().to_owned();
    let bus = BusSettings::read(dir, &top)?;
    let columns = ColumnSettings::read(&top)?;
    let settings = Settings {
        bus: Some(&bus),
        columns: columns.as_ref(),
        linkage,
        longest_step_s,
    };
    let (runs, logs): (Vec<Run>, _) = runs(dir, &top, settings)?.into_iter().unzip();
    // The rate of the first run's time stamps.
    let logged_rate_hz = runs
        .first()
        .map_or(0.0, |run| 1.0 / median_step_s(&run.time_s));
    let sample_rate_hz = declared_rate_hz.unwrap_or(logged_rate_hz);
    let campaign = Campaign {
        name,
        description,
        sample_rate_hz,
        synchronous,
        noise,
        runs,
    };
    Ok((campaign, logs))
}

/// Whether the campaign declares that one clock stamps all channels.
fn synchronous(top: &TomlTable) -> Result<bool, CampaignError> {
    match top.text("clocks")? {
        None | Some("independent") => Ok(false),
        Some("synchronous") => Ok(true),
        Some(other) => {
            let what = format!("clocks {} are not known", quote(other));
            let hint = "use \"synchronous\" or \"independent\"";
            Err(top.error_at("clocks", what, hint))
        }
    }
}

fn noise(top: &TomlTable<'_>) -> Result<Noise, CampaignError> {
    let Some(table) = top.table("noise")? else {
        return Ok(Noise::default());
    };
    let channels = Channel::ALL.map(Channel::key);
    let others = ["lift_current_a", "lower_current_a", "oil_temperature_c"];
    table.only(&[&others[..], &channels[..]].concat())?;
    let mut noise = Noise {
        lift_current_a: table.number(others[0], SIGMA)?,
        lower_current_a: table.number(others[1], SIGMA)?,
        oil_temperature_c: table.number(others[2], SIGMA)?,
        channels: [None; 4],
    };
    for channel in Channel::ALL {
        noise.channels[channel.index()] = table.number(channel.key(), SIGMA)?;
    }
    Ok(noise)
}

fn runs(
    dir: &Path,
    top: &TomlTable<'_>,
    settings: Settings<'_>,
) -> Result<Vec<(Run, LogNotes)>, CampaignError> {
    let tables = top.tables("run")?;
    if tables.is_empty() {
        let hint = "add a [[run]] block for every log";
        return Err(top.error_at("run", "the campaign has no runs", hint));
    }
    let mut runs = Vec::with_capacity(tables.len());
    let mut parts: Vec<(&str, Cut)> = Vec::with_capacity(tables.len());
    let files = tables.iter().map(|table| file_name(table, "file"));
    let files = files.collect::<Result<Vec<&str>, CampaignError>>()?;
    // A log of several consecutive runs is read once.
    let mut last: Option<(Vec<PathBuf>, Option<ColumnSettings>, Table)> = None;
    for (table, &file) in tables.iter().zip(&files) {
        let cut = Cut::read(table)?;
        let mut others = parts.iter();
        if others.any(|(other, part)| *other == file && part.overlaps(cut)) {
            let what = format!("{} is listed twice", quote(file));
            let hint = "delete one of the two [[run]] blocks, or give them times (from_s, to_s) that don't overlap";
            return Err(table.error_at("file", what, hint));
        }
        parts.push((file, cut));
        let (bench, oil_temperature_c) = conditions(table)?;
        let paths = logs_of(dir, table)?;
        let own = ColumnSettings::read(table)?;
        let log = match last.take() {
            Some((logs, columns, read)) if logs == paths && columns == own => read,
            _ => {
                let columns = own.as_ref().or(settings.columns);
                let settings = Settings {
                    columns,
                    ..settings
                };
                joined(&paths, settings)?
            }
        };
        let (name, step_s) = (called(file, &files), settings.longest_step_s);
        let run = run_log::run(&log, name, cut, bench, oil_temperature_c, step_s)?;
        run_log::check_usable(&paths[0], &run)?;
        runs.push((run, log.notes()));
        last = Some((paths, own, log));
    }
    Ok(runs)
}

/// The files of a run: its log, and those in which its recording continues.
fn logs_of(dir: &Path, table: &TomlTable<'_>) -> Result<Vec<PathBuf>, CampaignError> {
    let mut paths = vec![file_in(dir, table, "file")?];
    for file in table.texts(THEN)?.unwrap_or_default() {
        let path = dir.join(file);
        if !path.exists() {
            let what = format!("file {} does not exist", quote(file));
            return Err(table.error_at(THEN, what, "correct the name, or delete it from the list"));
        }
        paths.push(path);
    }
    Ok(paths)
}

/// The log of a recording in these files, the first of which exists.
fn joined(paths: &[PathBuf], settings: Settings<'_>) -> Result<Table, CampaignError> {
    let mut log = run_log::table(&paths[0], settings)?;
    for path in &paths[1..] {
        log = log.joined(&run_log::table(path, settings)?)?;
    }
    Ok(log)
}

/// Whether the log of each run of a manifest continues that of the run before it, with the same columns.
pub fn continued(
    dir: &Path,
    source: &SourceFile,
    linkage: &Linkage,
) -> Result<Vec<bool>, CampaignError> {
    let top = TomlTable::parse(source)?;
    let bus = BusSettings::read(dir, &top)?;
    let common = ColumnSettings::read(&top)?;
    let mut last: Option<(Option<ColumnSettings>, Table)> = None;
    let mut continued = Vec::new();
    for table in top.tables("run")? {
        let own = ColumnSettings::read(&table)?.or_else(|| common.clone());
        let settings = Settings {
            bus: Some(&bus),
            columns: own.as_ref(),
            linkage,
            ..Settings::default()
        };
        let log = joined(&logs_of(dir, &table)?, settings)?;
        let is_next =
            last.is_some_and(|(columns, last)| columns == own && last.is_continued_by(&log));
        continued.push(is_next);
        last = Some((own, log));
    }
    Ok(continued)
}

/// Display name of a log: the file name of a log elsewhere, unless another one has the same name.
fn called<'f>(file: &'f str, files: &[&str]) -> &'f str {
    let name_of = |file: &'f str| Path::new(file).file_name()?.to_str();
    let name = name_of(file).filter(|_| Path::new(file).is_absolute());
    let is_shared = |name: &str| {
        let others = files.iter().filter(|other| **other != file);
        others.map(Path::new).any(|other| other.ends_with(name))
    };
    name.filter(|name| !is_shared(name)).unwrap_or(file)
}

/// Test stand of a run, and its oil temperature if stated, degrees Celsius.
fn conditions(table: &TomlTable<'_>) -> Result<(Bench, Option<f64>), CampaignError> {
    let others = [
        "file",
        THEN,
        "bench",
        "load_kg",
        "port_pressure_bar",
        "oil_temperature_c",
        "columns",
    ];
    table.only(&[&others[..], &Cut::KEYS[..]].concat())?;
    let bench = match table.required_text("bench")? {
        "hitch" => {
            belongs_elsewhere(table, "port_pressure_bar", "flow")?;
            Bench::Hitch {
                load_kg: table.required_number("load_kg", LOAD_KG)?,
            }
        }
        "flow" => {
            belongs_elsewhere(table, "load_kg", "hitch")?;
            Bench::Flow {
                port_pressure_bar: table.required_number("port_pressure_bar", PORT_PRESSURE_BAR)?,
            }
        }
        other => {
            let what = format!("bench {} is not known", quote(other));
            return Err(table.error_at("bench", what, "use \"hitch\" or \"flow\""));
        }
    };
    Ok((bench, table.number("oil_temperature_c", OIL_TEMPERATURE_C)?))
}

fn belongs_elsewhere(table: &TomlTable<'_>, key: &str, bench: &str) -> Result<(), CampaignError> {
    if !table.has(key) {
        return Ok(());
    }
    let what = format!("{key} is valid only for a run on the {bench} bench");
    let hint = format!("delete the line, or write bench = \"{bench}\"");
    Err(table.error_at(key, what, hint))
}
