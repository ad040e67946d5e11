//! Runs that a logger took from a CAN bus: candump's `.log` and Vector's `.asc`, read by a description of the bus
//! (DBC).
//!
//! ```text
//! log --(candump, asc)--> frames --(listener: signals of the DBC)--> series of each column --> rows of a run
//! ```
//!
//! A row is a sample of the lift current. What comes in another message is brought to its time by a straight line, if
//! it was sampled no further away than half a row.
mod asc;
mod candump;
mod clock;
mod description;
mod frame;
mod line;
mod listener;

mod settings;
mod signal;

use std::path::Path;
use std::sync::Arc;

pub use settings::BusSettings;

use super::CampaignError;
use super::series::Series;
use super::table::{Cells, LIFT, LOWER, Samples, TIME, Table};
use crate::source_file::SourceFile;
use listener::Listener;

/// A kind of log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// candump's.
    Candump,
    /// Vector's.
    Asc,
}

impl Format {
    /// By the end of the file's name; `None` if that is no log of a bus.
    pub fn of(path: &Path) -> Option<Self> {
        let end = path.extension()?.to_str()?.to_ascii_lowercase();
        match end.as_str() {
            "log" => Some(Self::Candump),
            "asc" => Some(Self::Asc),
            _ => None,
        }
    }
}

/// Reads a log of a bus.
///
/// # Errors
/// Whatever is wrong first, by file, line and column.
pub fn read(
    source: &Arc<SourceFile>,
    format: Format,
    settings: &BusSettings,
) -> Result<Table, CampaignError> {
    let mut listener = settings.listener();
    let mut take = |frame: &frame::Frame<'_>| listener.take(source, frame);
    match format {
        Format::Candump => candump::read(source, &mut take)?,
        Format::Asc => asc::read(source, &mut take)?,
    }
    let rows = required(source, &listener, settings, LIFT)?;
    required(source, &listener, settings, LOWER)?;
    let within_s = rows.median_step_s() / 2.0;
    let samples = |name, values| Samples {
        name,
        cell: 0,
        values,
    };
    let mut columns = vec![samples(TIME, rows.times_s.clone())];
    for (column, series) in listener.series() {
        columns.push(samples(column.name, series.at(&rows.times_s, within_s)));
    }
    let bytes = rows.bytes.clone();
    Table::new(Arc::clone(source), columns, bytes, Cells::OneALine)
}

/// A current: without it there is no run.
fn required<'l>(
    source: &SourceFile,
    listener: &'l Listener<'_>,
    settings: &BusSettings,
    name: &str,
) -> Result<&'l Series, CampaignError> {
    let mut of_column = listener.series().filter(|(column, _)| column.name == name);
    let series = of_column.next().map(|(_, series)| series);
    series
        .filter(|series| !series.times_s.is_empty())
        .ok_or_else(|| {
            let what = match settings.signal(name) {
                Some(signal) => format!("holds no {signal}, which is {name}"),
                None => format!("{name} is taken from no signal"),
            };
            source.error(what, settings.how_to_get(name))
        })
}
