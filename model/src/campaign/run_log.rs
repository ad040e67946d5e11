//! One run's CSV log: a header whose names carry their unit, then numbers.
use std::ops::RangeInclusive;
use std::path::Path;

use csv::StringRecord;

use super::{Bench, CampaignError, Channel, Run, dropout};
use crate::input_error::{InputError, Place, quote};
use crate::naming::{offer_names, unknown_name};
use crate::source_file::SourceFile;

/// Longest step between two samples, s: what the valves did in a longer one is not known.
const LONGEST_STEP_S: f64 = 2.0;
/// Time stamps, s: beyond, the step between two samples drowns in rounding.
const TIME_S: RangeInclusive<f64> = -1e7..=1e10;

const TIME: &str = "time_s";
const LIFT: &str = "lift_current_a";
const LOWER: &str = "lower_current_a";
const OIL_TEMPERATURE: &str = "oil_temperature_c";

/// Every column there is, and the values that its instrument can show.
const COLUMNS: [(&str, RangeInclusive<f64>); 8] = [
    (TIME, TIME_S),
    (LIFT, -10.0..=10.0),
    (LOWER, -10.0..=10.0),
    (Channel::PumpPressure.key(), -10.0..=1000.0),
    (Channel::CylinderPressure.key(), -10.0..=1000.0),
    (Channel::Flow.key(), -1000.0..=1000.0),
    (Channel::RockerAngle.key(), -360.0..=360.0),
    (OIL_TEMPERATURE, -60.0..=250.0),
];

/// Reads one log; it may hold currents only.
pub fn read(
    path: &Path,
    file: &str,
    bench: Bench,
    oil_temperature_c: f64,
) -> Result<Run, CampaignError> {
    let source = SourceFile::read(path)?;
    let table = Table::parse(&source)?;
    let time_s = table.required(TIME)?;
    table.check_time(time_s)?;
    let lift_current_a = table.current(LIFT, time_s)?;
    let lower_current_a = table.current(LOWER, time_s)?;
    let channels = Channel::ALL.map(|channel| {
        let measurable = channel != Channel::RockerAngle || matches!(bench, Bench::Hitch { .. });
        table.measured(channel.key()).filter(|_| measurable)
    });
    Ok(Run {
        file: file.to_owned(),
        bench,
        oil_temperature_c,
        time_s: time_s.to_vec(),
        lift_current_a,
        lower_current_a,
        channels,
        oil_temperature_log_c: table.measured(OIL_TEMPERATURE),
    })
}

/// Refuses a run that has nothing to compare a model with.
pub fn check_usable(path: &Path, run: &Run) -> Result<(), CampaignError> {
    if run.channels.iter().any(Option::is_some) {
        return Ok(());
    }
    let known = Channel::ALL.map(Channel::key).join(", ");
    Err(InputError::of_file(
        path,
        "has no usable channel",
        format!("log at least one of {known}"),
    ))
}

/// The numbers of a log by column; NaN where a cell is empty.
struct Table<'a> {
    source: &'a SourceFile,
    columns: Vec<(&'static str, Vec<f64>)>,
    /// First byte of each row in the file.
    rows: Vec<usize>,
}

impl<'a> Table<'a> {
    fn parse(source: &'a SourceFile) -> Result<Self, CampaignError> {
        let mut reader = csv::ReaderBuilder::new()
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(source.text.as_bytes());
        let header = reader
            .headers()
            .map_err(|error| not_csv(source, &error))?
            .clone();
        let header_byte = row_start(source, 0);
        let names = column_names(source, &header, header_byte)?;
        let mut table = Self {
            source,
            columns: names.iter().map(|name| (*name, Vec::new())).collect(),
            rows: Vec::new(),
        };
        let mut record = StringRecord::new();
        while reader
            .read_record(&mut record)
            .map_err(|error| not_csv(source, &error))?
        {
            let byte = record
                .position()
                .map_or(0, |position| position.byte() as usize);
            table.push_row(&record, row_start(source, byte))?;
        }
        match table.rows.len() {
            0 => Err(source.error("holds a header but no samples", "log the run again")),
            n if n < Run::FEWEST_SAMPLES => {
                let what = format!("holds {n} samples only");
                Err(source.error(
                    what,
                    format!("a run needs at least {}", Run::FEWEST_SAMPLES),
                ))
            }
            _ => Ok(table),
        }
    }

    fn push_row(&mut self, record: &StringRecord, byte: usize) -> Result<(), CampaignError> {
        if record.len() != self.columns.len() {
            let what = format!(
                "the row has {} cells, the header has {}",
                record.len(),
                self.columns.len()
            );
            return Err(self.source.error_at(
                byte,
                what,
                "leave the cell of a dropout empty, but keep its comma",
            ));
        }
        self.rows.push(byte);
        for (index, cell) in record.iter().enumerate() {
            let name = self.columns[index].0;
            let value = number(name, cell)
                .map_err(|(what, mend)| self.error_at(byte, index, what, mend))?;
            self.columns[index].1.push(value);
        }
        Ok(())
    }

    fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, values)| values.as_slice())
    }

    fn required(&self, name: &str) -> Result<&[f64], CampaignError> {
        self.column(name).ok_or_else(|| {
            let what = format!("column {name} is missing");
            self.source.error_at(
                0,
                what,
                format!("log it: every run needs {TIME}, {LIFT} and {LOWER}"),
            )
        })
    }

    /// A measured column, if there is one and it holds anything.
    fn measured(&self, name: &str) -> Option<Vec<f64>> {
        let values = self.column(name)?;
        values
            .iter()
            .any(|value| !value.is_nan())
            .then(|| values.to_vec())
    }

    /// A current, with its dropouts bridged.
    fn current(&self, name: &str, time_s: &[f64]) -> Result<Vec<f64>, CampaignError> {
        let mut current_a = self.required(name)?.to_vec();
        match dropout::bridge(time_s, &mut current_a) {
            Ok(()) => Ok(current_a),
            Err(gap) => {
                let what = if gap.duration_s.is_finite() {
                    format!("{name} is missing for {:.2} s", gap.duration_s)
                } else {
                    format!("{name} has no values")
                };
                let mend =
                    "the currents drive the model: log the run again, or cut it before the gap";
                Err(self.error_in(gap.sample, name, what, mend))
            }
        }
    }

    fn check_time(&self, time_s: &[f64]) -> Result<(), CampaignError> {
        for (sample, pair) in time_s.windows(2).enumerate() {
            let (before_s, now_s) = (pair[0], pair[1]);
            let fault = if now_s < before_s {
                "goes back"
            } else if now_s == before_s {
                "stands still"
            } else if now_s - before_s > LONGEST_STEP_S {
                "jumps"
            } else {
                continue;
            };
            let what = format!("time {fault}: {now_s} s after {before_s} s");
            let mend = format!("{TIME} has to rise from row to row, by {LONGEST_STEP_S} s at most");
            return Err(self.error_in(sample + 1, TIME, what, mend));
        }
        Ok(())
    }

    fn error_in(
        &self,
        row: usize,
        name: &str,
        what: String,
        mend: impl Into<String>,
    ) -> InputError {
        let index = self
            .columns
            .iter()
            .position(|(known, _)| *known == name)
            .unwrap_or(0);
        self.error_at(self.rows.get(row).copied().unwrap_or(0), index, what, mend)
    }

    fn error_at(
        &self,
        row_byte: usize,
        index: usize,
        what: String,
        mend: impl Into<String>,
    ) -> InputError {
        cell_error(self.source, row_byte, index, what, mend)
    }
}

/// Checks the header and gives each column its name.
fn column_names(
    source: &SourceFile,
    header: &StringRecord,
    byte: usize,
) -> Result<Vec<&'static str>, CampaignError> {
    if header.is_empty() {
        return Err(source.error("is empty", "a log has a header and a row a sample"));
    }
    let known = COLUMNS.map(|(name, _)| name);
    let mut names: Vec<&'static str> = Vec::with_capacity(header.len());
    for (index, given) in header.iter().enumerate() {
        let Some(name) = known.iter().find(|name| **name == given) else {
            let (what, mend) = unknown_column(given, index, header, &known);
            return Err(cell_error(source, byte, index, what, mend));
        };
        if names.contains(name) {
            let what = format!("column {name} is there twice");
            return Err(cell_error(
                source,
                byte,
                index,
                what,
                "delete one of the two",
            ));
        }
        names.push(name);
    }
    Ok(names)
}

fn unknown_column(
    given: &str,
    index: usize,
    header: &StringRecord,
    known: &[&str],
) -> (String, String) {
    if given.is_empty() {
        return (
            format!("column {} has no name", index + 1),
            "delete the column or name it".to_owned(),
        );
    }
    if header.len() == 1 && given.contains([';', '\t']) {
        return (
            "columns are not separated by commas".to_owned(),
            "write a,b,c with decimal points".to_owned(),
        );
    }
    if given.parse::<f64>().is_ok() {
        return (
            format!("{} stands where a column's name should", quote(given)),
            "begin with a header".to_owned(),
        );
    }
    (
        unknown_name("column", given, known),
        offer_names(given, known),
    )
}

/// The number in a cell; NaN if the cell is empty, which only time may not be.
fn number(name: &'static str, cell: &str) -> Result<f64, (String, String)> {
    if cell.is_empty() && name != TIME {
        return Ok(f64::NAN);
    }
    let mend = if name == TIME {
        "every row needs its time"
    } else {
        "leave the cell of a dropout empty"
    };
    let value: f64 = match cell.parse() {
        Ok(value) => value,
        Err(_) => {
            return Err((
                format!("{} in column {name} is not a number", quote(cell)),
                mend.to_owned(),
            ));
        }
    };
    let range = COLUMNS
        .iter()
        .find(|(known, _)| *known == name)
        .map_or(TIME_S, |(_, range)| range.clone());
    if range.contains(&value) {
        return Ok(value);
    }
    if !value.is_finite() {
        return Err((
            format!("{} in column {name} is not finite", quote(cell)),
            mend.to_owned(),
        ));
    }
    let mend = format!("it may be {} to {}; {mend}", range.start(), range.end());
    Err((format!("{value} in column {name} cannot be"), mend))
}

fn not_csv(source: &SourceFile, error: &csv::Error) -> InputError {
    let byte = error
        .position()
        .map_or(0, |position| position.byte() as usize);
    source.error_at(byte, format!("is not CSV: {error}"), "")
}

/// The reader counts the line breaks before a row as part of it; an editor does not.
fn row_start(source: &SourceFile, byte: usize) -> usize {
    let rest = &source.text.as_bytes()[byte.min(source.text.len())..];
    byte + rest
        .iter()
        .take_while(|b| matches!(b, b'\n' | b'\r'))
        .count()
}

fn cell_error(
    source: &SourceFile,
    row_byte: usize,
    index: usize,
    what: String,
    mend: impl Into<String>,
) -> InputError {
    let Place { line, column } = source.place(row_byte);
    let row = source.text.get(row_byte..).unwrap_or_default();
    let before = cells_before(row, index);
    InputError::at(
        &source.path,
        Place {
            line,
            column: column + before,
        },
        what,
        mend,
    )
}

/// Characters of a row in front of its cell `index`.
fn cells_before(row: &str, index: usize) -> usize {
    let (mut quoted, mut commas) = (false, 0);
    for (characters, c) in row.chars().enumerate() {
        if commas == index {
            return characters;
        }
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => commas += 1,
            '\n' | '\r' if !quoted => return characters,
            _ => {}
        }
    }
    row.chars().count()
}
