//! The numbers of a log by column, independent of the format.

use std::cmp::Ordering;
use std::sync::Arc;

use hitch_input::input_error::{InputError, Position};
use hitch_input::source_file::SourceFile;

use crate::cell_error::cell_error;
use crate::cut::Cut;
use crate::dropout;
use crate::dropout::SHORT_GAP_S as LONGEST_GAP_S;
use crate::own_rate::{OwnRate, own_rate};
use crate::recorded::{CampaignError, Run};
use crate::run_columns::{LIFT, LOWER, TIME};
use crate::series::{Series, median_step_s, rises, values};

/// Longest step between two samples, s: the valve motion within a longer one is unknown.
pub const LONGEST_STEP_S: f64 = 2.0;
/// Layout of the samples of a row in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cells {
    /// Consecutive, with this separator.
    Between(char),
    /// At unspecified positions in the line.
    OneALine,
    /// In a binary file.
    Nowhere,
}

/// The samples of one column.
#[derive(Debug, Clone)]
struct Samples {
    /// The column's name.
    name: &'static str,
    /// Its cell index, if rows have cells.
    cell: usize,
    /// Its samples; NaN where missing.
    values: Vec<f64>,
}

/// The numbers of a log by column; NaN for empty cells.
#[derive(Debug, Clone)]
pub struct Table {
    /// The files, each with its first row.
    sources: Vec<(usize, Arc<SourceFile>)>,
    columns: Vec<Samples>,
    /// Byte offset of each row in its file.
    rows: Vec<usize>,
    cells: Cells,
    /// Time of the logger's clock at time 0, s; zero if it is unknown.
    origin_s: f64,
    /// Where the logger's clock was set back or stood still. The times continue after a pause.
    set_back: Vec<SetBack>,
    /// How much is kept of a recording that is cut off.
    cut_off: Option<String>,
    /// The channels with a lower rate than their rows, one line each.
    rates: Vec<String>,
}

/// What a reader of a log should know, and its numbers do not tell.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct LogNotes {
    /// The steps of its clock.
    pub steps: Vec<ClockStep>,
    /// How much is kept of a recording that is cut off.
    pub cut_off: Option<String>,
    /// The channels with a lower rate than their rows, one line each.
    pub rates: Vec<String>,
}

/// A row that is not later than the one before it.
#[derive(Debug, Clone, Copy)]
struct SetBack {
    row: usize,
    /// Time of the row before it, as logged, s.
    from_s: f64,
    /// Its time as logged, s.
    to_s: f64,
}

/// A step of a logger's clock, which no run contains.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClockStep {
    /// The first sample behind it.
    pub sample: usize,
    /// The fault, with its line.
    pub said: String,
}

impl Table {
    /// The table of these columns, as long as `rows`, the byte offset of each row in the file.
    ///
    /// # Errors
    /// There are too few rows for a run.
    fn new(
        source: Arc<SourceFile>,
        columns: Vec<Samples>,
        rows: Vec<usize>,
        cells: Cells,
    ) -> Result<Self, CampaignError> {
        match rows.len() {
            0 => Err(source.error("contains no samples", "log the run again")),
            n if n < Run::FEWEST_SAMPLES => {
                let what = format!("contains only {n} samples");
                let hint = format!("a run needs at least {}", Run::FEWEST_SAMPLES);
                Err(source.error(what, hint))
            }
            _ => Ok(Self {
                sources: vec![(0, source)],
                columns,
                rows,
                cells,
                origin_s: 0.0,
                set_back: Vec::new(),
                cut_off: None,
                rates: Vec::new(),
            }),
        }
    }

    /// The table whose rows are the samples of the lift current. Samples of other series are moved to the times of the
    /// rows if one is within half a row; `time` and the series are given with their cells, if rows have cells. A series with a
    /// lower rate than its times counts as its own samples ([`own_rate`]).
    ///
    /// # Errors
    /// There are too few rows for a run.
    pub fn of_series<'s>(
        source: &Arc<SourceFile>,
        (time, rows): (usize, &Series),
        series: impl Iterator<Item = (&'static str, usize, &'s Series)>,
        cells: Cells,
    ) -> Result<Self, CampaignError> {
        let set_back = set_back(&rows.times_s);
        let pauses: Vec<f64> = set_back.iter().map(SetBack::pause_s).collect();
        let mut rates = Vec::new();
        let sampled = series.map(|(name, cell, series)| {
            let series = Series {
                times_s: continued(&series.times_s, &pauses),
                ..series.clone()
            };
            let own = own_rate(&series).filter(|own| is_usable(name, own, &set_back));
            rates.extend(own.as_ref().map(|own| own.note(name)));
            (name, cell, own.map_or(series, |own| own.samples))
        });
        let sampled: Vec<(&'static str, usize, Series)> = sampled.collect();
        let rows = Series {
            times_s: continued(&rows.times_s, &pauses),
            ..rows.clone()
        };
        let rows = &rows_of_lift(rows, &sampled);
        let times_s = &rows.times_s;
        let within_s = median_step_s(times_s) / 2.0;
        let samples = |name, cell, values| Samples { name, cell, values };
        let moved = sampled.iter().map(|(name, cell, series)| {
            samples(name, *cell, values(name, series, times_s, within_s))
        });
        let columns = std::iter::once(samples(TIME, time, times_s.clone()));
        let columns = columns.chain(moved).collect();
        let table = Self::new(Arc::clone(source), columns, rows.bytes.clone(), cells)?;
        Ok(Self {
            set_back,
            rates,
            ..table
        })
    }

    /// The same table, whose time 0 is that of the logger's clock, s.
    pub fn since(self, origin_s: f64) -> Self {
        Self { origin_s, ..self }
    }

    /// The same table, of a recording that is cut off behind its last row.
    pub fn cut_off(self) -> Self {
        let times_s = self.column(TIME).unwrap_or_default();
        let lasts_s = times_s.last().zip(times_s.first());
        let lasts_s = lasts_s.map_or(0.0, |(last_s, first_s)| last_s - first_s);
        let kept = format!(
            "the file is cut off: {} samples, {lasts_s:.2} s, are whole",
            times_s.len()
        );
        Self {
            cut_off: Some(kept),
            ..self
        }
    }

    /// Whether another table has the same columns, and times that continue: it belongs to the same recording.
    pub fn is_continued_by(&self, next: &Self) -> bool {
        let times_s = self.column(TIME).unwrap_or_default();
        let next_s = next.column(TIME).unwrap_or_default().first();
        let Some((last_s, next_s)) = times_s.last().zip(next_s) else {
            return false;
        };
        let step_s = next.origin_s + next_s - (self.origin_s + last_s);
        let is_next = step_s > 0.0 && step_s - median_step_s(times_s) <= LONGEST_GAP_S;
        let [own, others] = [self, next].map(|table| table.columns.iter().map(|of| of.name));
        is_next && own.eq(others)
    }

    /// The rows of this table, and below them those of the next file of its recording.
    ///
    /// # Errors
    /// The next table does not continue this one.
    pub fn joined(mut self, next: &Self) -> Result<Self, CampaignError> {
        if !self.is_continued_by(next) {
            let what = format!("does not continue {}", self.sources[0].1.path.display());
            let hint = "joined files have the same columns, and times that continue: give it a [[run]] block of its own";
            return Err(next.sources[0].1.error(what, hint));
        }
        let later_s = next.origin_s - self.origin_s;
        let rows = self.rows.len();
        let sources = next.sources.iter();
        self.sources
            .extend(sources.map(|(row, source)| (rows + row, Arc::clone(source))));
        self.rows.extend(&next.rows);
        let later = next.set_back.iter().map(|one| one.after(rows));
        self.set_back.extend(later);
        self.cut_off = self.cut_off.or_else(|| next.cut_off.clone());
        let others = next.rates.iter().filter(|rate| !self.rates.contains(rate));
        let others: Vec<String> = others.cloned().collect();
        self.rates.extend(others);
        for (own, samples) in self.columns.iter_mut().zip(&next.columns) {
            let later = if own.name == TIME { later_s } else { 0.0 };
            own.values
                .extend(samples.values.iter().map(|value| value + later));
        }
        Ok(self)
    }

    /// The file of a row.
    fn source(&self, row: usize) -> &Arc<SourceFile> {
        let after = self.sources.partition_point(|(first, _)| *first <= row);
        &self.sources[after.saturating_sub(1)].1
    }

    /// The rows of a time span.
    ///
    /// # Errors
    /// There are too few rows for a run.
    pub fn cut(&self, cut: Cut) -> Result<Self, CampaignError> {
        let times_s = self.column(TIME).unwrap_or_default();
        let first_s = times_s.first().copied().unwrap_or_default();
        let stays: Vec<bool> = times_s
            .iter()
            .map(|time_s| cut.contains(time_s - first_s))
            .collect();
        if cut == Cut::NONE || stays.is_empty() {
            return Ok(self.clone());
        }
        let kept = stays.iter().filter(|stays| **stays).count();
        if kept < Run::FEWEST_SAMPLES {
            let what = format!("contains only {kept} samples within the run");
            let hint = format!(
                "a run needs at least {}; from_s and to_s are seconds after the first sample",
                Run::FEWEST_SAMPLES
            );
            return Err(self.source(0).error(what, hint));
        }
        let before = stays.iter().take_while(|stays| !**stays).count();
        let sources = self.sources.iter();
        let sources = sources.map(|(row, source)| (row.saturating_sub(before), Arc::clone(source)));
        let columns = self.columns.iter().map(|samples| Samples {
            values: kept_of(&samples.values, &stays),
            ..*samples
        });
        Ok(Self {
            sources: sources.collect(),
            columns: columns.collect(),
            rows: kept_of(&self.rows, &stays),
            cells: self.cells,
            origin_s: self.origin_s,
            // The first row of a part follows none.
            set_back: (self.set_back.iter())
                .filter(|one| one.row > before && stays[one.row])
                .map(|one| SetBack {
                    row: one.row - before,
                    ..*one
                })
                .collect(),
            cut_off: self.cut_off.clone(),
            rates: self.rates.clone(),
        })
    }

    fn column(&self, name: &str) -> Option<&[f64]> {
        let found = self.columns.iter().find(|samples| samples.name == name);
        found.map(|samples| samples.values.as_slice())
    }

    /// A required column.
    ///
    /// # Errors
    /// The column is missing.
    pub fn required(&self, name: &str) -> Result<&[f64], CampaignError> {
        self.column(name).ok_or_else(|| {
            let what = format!("column {name} is missing");
            let hint = format!("log it: every run needs {TIME}, {LIFT} and {LOWER}");
            match self.cells {
                Cells::Nowhere => self.source(0).error(what, hint),
                _ => self.source(0).error_at(0, what, hint),
            }
        })
    }

    /// A measured column, if it exists and has values.
    pub fn measured(&self, name: &str) -> Option<Vec<f64>> {
        let values = self.column(name)?;
        let is_measured = values.iter().any(|value| !value.is_nan());
        is_measured.then(|| values.to_vec())
    }

    /// A current, with its dropouts filled.
    ///
    /// # Errors
    /// A dropout is too long.
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
                let hint = "the currents are inputs of the model: log the run again, or cut it before the gap";
                Err(self.error_in(gap.sample, name, what, hint))
            }
        }
    }

    /// Rejects times that do not increase from row to row.
    ///
    /// # Errors
    /// The first row that is not later than the previous one, or later by more than `longest_s`.
    pub fn check_time(&self, time_s: &[f64], longest_s: f64) -> Result<(), CampaignError> {
        let is_wrong = |pair: &[f64]| pair[1] <= pair[0] || pair[1] - pair[0] > longest_s;
        let Some(before) = time_s.windows(2).position(is_wrong) else {
            return Ok(());
        };
        let (what, from_s, to_s) = self.step(before + 1, time_s);
        let what = format!("time {what}: {to_s} s after {from_s} s");
        let hint = if rises(time_s) {
            format!("{TIME} has to rise from row to row, in steps of at most {LONGEST_STEP_S} s")
        } else {
            "export the times with more digits".to_owned()
        };
        Err(self.error_in(before + 1, TIME, what, hint))
    }

    /// What a reader of the log should know.
    pub fn notes(&self) -> LogNotes {
        LogNotes {
            steps: self.clock_steps(),
            cut_off: self.cut_off.clone(),
            rates: self.rates.clone(),
        }
    }

    /// The steps of the logger's clock: back, or ahead by more than a dropout.
    fn clock_steps(&self) -> Vec<ClockStep> {
        let times_s = self.column(TIME).unwrap_or_default();
        let first_s = times_s.first().copied().unwrap_or_default();
        let usual_s = median_step_s(times_s);
        let pairs = times_s.windows(2).enumerate();
        let steps = pairs.filter(|(_, pair)| pair[1] - pair[0] - usual_s > LONGEST_GAP_S);
        let said = |(before, _)| {
            let sample = before + 1;
            let (what, from_s, to_s) = self.step(sample, times_s);
            let step = format!(
                "its clock {what} from {:.2} s to {:.2} s",
                from_s - first_s,
                to_s - first_s
            );
            let said = match self.error_in(sample, TIME, String::new(), "").place {
                Some(Position { line, .. }) => format!("line {line}: {step}"),
                None => format!("row {}: {step}", sample + 1),
            };
            ClockStep { sample, said }
        };
        steps.map(said).collect()
    }

    /// What the clock does before a row, and its times as logged, s.
    fn step(&self, row: usize, times_s: &[f64]) -> (&'static str, f64, f64) {
        let of_row = self.set_back.iter().find(|one| one.row == row);
        let (from_s, to_s) = match of_row {
            Some(one) => (one.from_s, one.to_s),
            None => (times_s[row - 1], times_s[row]),
        };
        let what = match to_s.total_cmp(&from_s) {
            Ordering::Less => "goes back",
            Ordering::Equal => "stands still",
            Ordering::Greater => "jumps",
        };
        (what, from_s, to_s)
    }

    fn error_in(
        &self,
        row: usize,
        name: &str,
        what: String,
        hint: impl Into<String>,
    ) -> InputError {
        let samples = self.columns.iter().find(|samples| samples.name == name);
        let cell = samples.map_or(0, |samples| samples.cell);
        let byte = self.rows.get(row).copied().unwrap_or(0);
        match self.cells {
            Cells::Between(mark) => cell_error(self.source(row), byte, (cell, mark), what, hint),
            Cells::OneALine => self.source(row).error_at(byte, what, hint),
            Cells::Nowhere => self.source(row).error(what, hint),
        }
    }
}

impl SetBack {
    /// Time by which the rows from it on are moved, so that they follow those before it after a pause, s.
    fn pause_s(&self) -> f64 {
        self.from_s - self.to_s + 2.0 * LONGEST_STEP_S
    }

    /// The same in a table with this many rows above it.
    fn after(self, rows: usize) -> Self {
        let row = self.row + rows;
        Self { row, ..self }
    }
}

/// Where times are set back or stand still; nothing in times that rarely rise, which are no times of a run.
fn set_back(times_s: &[f64]) -> Vec<SetBack> {
    if !rises(times_s) {
        return Vec::new();
    }
    let pairs = times_s.windows(2).enumerate();
    let back = pairs.filter(|(_, pair)| pair[1] <= pair[0]);
    back.map(|(before, pair)| SetBack {
        row: before + 1,
        from_s: pair[0],
        to_s: pair[1],
    })
    .collect()
}

/// Times that are moved by each of these pauses where they are set back; as they are if that is at other places, s.
fn continued(times_s: &[f64], pauses_s: &[f64]) -> Vec<f64> {
    let is_back = |pair: &&[f64]| pair[1] <= pair[0];
    if times_s.windows(2).filter(is_back).count() != pauses_s.len() {
        return times_s.to_vec();
    }
    let mut pauses_s = pauses_s.iter();
    let (mut later_s, mut last_s) = (0.0, f64::NEG_INFINITY);
    let moved = times_s.iter().map(|&time_s| {
        if time_s <= last_s {
            later_s += pauses_s.next().copied().unwrap_or_default();
        }
        last_s = time_s;
        time_s + later_s
    });
    moved.collect()
}

/// Whether the samples of a channel with its own rate replace its rows. Between those of a current, which is interpolated, a
/// step is at an unknown time, so they have to be as close as the sides of a gap; else the current is used as it is.
fn is_usable(name: &str, own: &OwnRate, set_back: &[SetBack]) -> bool {
    let is_current = [LIFT, LOWER].contains(&name);
    !is_current || (own.longest_step_s <= LONGEST_GAP_S && set_back.is_empty())
}

/// The rows of a table: the samples of the lift current, also if it has a lower rate than the rows of the log.
fn rows_of_lift(rows: Series, sampled: &[(&'static str, usize, Series)]) -> Series {
    let lift = sampled.iter().find(|(name, ..)| *name == LIFT);
    let last_s = rows.times_s.last().copied();
    match lift.zip(last_s) {
        Some(((_, _, lift), last_s)) if lift.times_s.len() < rows.times_s.len() => {
            lift.until(last_s)
        }
        _ => rows,
    }
}

fn kept_of<T: Copy>(values: &[T], stays: &[bool]) -> Vec<T> {
    let kept = values.iter().zip(stays).filter(|(_, stays)| **stays);
    kept.map(|(value, _)| *value).collect()
}
