//! The numbers of a log by column, wherever they came from.
use std::ops::RangeInclusive;

use super::cut::Cut;
use super::{CampaignError, Channel, Run, dropout};
use crate::input_error::{InputError, Place};
use crate::source_file::SourceFile;

/// Longest step between two samples, s: what the valves did in a longer one is not known.
const LONGEST_STEP_S: f64 = 2.0;
/// Time stamps, s: beyond, the step between two samples drowns in rounding.
const TIME_S: RangeInclusive<f64> = -1e7..=1e10;

/// Name of the column of times.
pub const TIME: &str = "time_s";
/// Name of the lift solenoid's current.
pub const LIFT: &str = "lift_current_a";
/// Name of the lowering solenoid's current.
pub const LOWER: &str = "lower_current_a";
/// Name of the oil temperature.
pub const OIL_TEMPERATURE: &str = "oil_temperature_c";

/// A column that a log may have.
#[derive(Debug)]
pub struct Column {
    /// Its name, which ends in its unit.
    pub name: &'static str,
    /// That unit, as formulas write it.
    pub unit: &'static str,
    /// The values that its instrument can show.
    pub range: RangeInclusive<f64>,
}

const fn known(name: &'static str, unit: &'static str, range: RangeInclusive<f64>) -> Column {
    Column { name, unit, range }
}

/// Every column there is.
pub static COLUMNS: [Column; 8] = [
    known(TIME, "s", TIME_S),
    known(LIFT, "A", -10.0..=10.0),
    known(LOWER, "A", -10.0..=10.0),
    known(Channel::PumpPressure.key(), "bar", -10.0..=1000.0),
    known(Channel::CylinderPressure.key(), "bar", -10.0..=1000.0),
    known(Channel::Flow.key(), "l/min", -1000.0..=1000.0),
    known(Channel::RockerAngle.key(), "deg", -360.0..=360.0),
    known(OIL_TEMPERATURE, "degC", -60.0..=250.0),
];

/// The column of that name.
pub fn column(name: &str) -> Option<&'static Column> {
    COLUMNS.iter().find(|column| column.name == name)
}

/// How the samples of a row stand in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cells {
    /// One after the other in the order of the columns, with commas between them.
    Commas,
    /// Somewhere in the line.
    OneALine,
}

/// The numbers of a log by column; NaN where a cell is empty.
#[derive(Debug)]
pub struct Table<'a> {
    source: &'a SourceFile,
    columns: Vec<(&'static str, Vec<f64>)>,
    /// First byte of each row in the file.
    rows: Vec<usize>,
    cells: Cells,
}

impl<'a> Table<'a> {
    /// The table of these columns, which are as long as `rows`: the first byte of each row in the file.
    ///
    /// # Errors
    /// If there are too few rows for a run.
    pub fn new(
        source: &'a SourceFile,
        columns: Vec<(&'static str, Vec<f64>)>,
        rows: Vec<usize>,
        cells: Cells,
    ) -> Result<Self, CampaignError> {
        match rows.len() {
            0 => Err(source.error("holds no samples", "log the run again")),
            n if n < Run::FEWEST_SAMPLES => {
                let what = format!("holds {n} samples only");
                let mend = format!("a run needs at least {}", Run::FEWEST_SAMPLES);
                Err(source.error(what, mend))
            }
            _ => Ok(Self {
                source,
                columns,
                rows,
                cells,
            }),
        }
    }

    /// The rows of a part.
    ///
    /// # Errors
    /// If there are too few for a run.
    pub fn cut(mut self, cut: Cut) -> Result<Self, CampaignError> {
        let times_s = self.column(TIME).unwrap_or_default();
        let first_s = times_s.first().copied().unwrap_or_default();
        let stays: Vec<bool> = times_s
            .iter()
            .map(|time_s| cut.contains(time_s - first_s))
            .collect();
        if cut == Cut::NONE || stays.is_empty() {
            return Ok(self);
        }
        let kept = stays.iter().filter(|stays| **stays).count();
        if kept < Run::FEWEST_SAMPLES {
            let what = format!("holds {kept} samples in the time of the run");
            let mend = format!(
                "a run needs at least {}; from_s and to_s are seconds after the first sample",
                Run::FEWEST_SAMPLES
            );
            return Err(self.source.error(what, mend));
        }
        for (_, values) in &mut self.columns {
            retain(values, &stays);
        }
        retain(&mut self.rows, &stays);
        Ok(self)
    }

    fn column(&self, name: &str) -> Option<&[f64]> {
        self.columns
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, values)| values.as_slice())
    }

    /// A column that every log has.
    ///
    /// # Errors
    /// If it is missing.
    pub fn required(&self, name: &str) -> Result<&[f64], CampaignError> {
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
    pub fn measured(&self, name: &str) -> Option<Vec<f64>> {
        let values = self.column(name)?;
        values
            .iter()
            .any(|value| !value.is_nan())
            .then(|| values.to_vec())
    }

    /// A current, with its dropouts bridged.
    ///
    /// # Errors
    /// If one is too long for that.
    pub fn current(&self, name: &str, time_s: &[f64]) -> Result<Vec<f64>, CampaignError> {
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

    /// Refuses times that don't rise from row to row.
    ///
    /// # Errors
    /// At the first row that is not later than the last, or much later.
    pub fn check_time(&self, time_s: &[f64]) -> Result<(), CampaignError> {
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
        match self.cells {
            Cells::Commas => cell_error(self.source, row_byte, index, what, mend),
            Cells::OneALine => self.source.error_at(row_byte, what, mend),
        }
    }
}

fn retain<T>(values: &mut Vec<T>, stays: &[bool]) {
    let mut stays = stays.iter();
    values.retain(|_| stays.next() == Some(&true));
}

/// A fault of cell `index` of a row with commas.
pub fn cell_error(
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
