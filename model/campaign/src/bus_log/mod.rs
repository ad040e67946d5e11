//! Runs from logs of a CAN bus: candump's `.log`, Vector's `.asc` and `.blf`, frames in MDF and tables of them, decoded by a description of the bus (DBC).
//!
//! ```text
//! log --(candump, asc, blf, mdf, table)--> frames --(listener: signals of the DBC)--> series of each column --> rows of a run
//! ```
//!
//! A row is a sample of the lift current. Signals of other messages are interpolated linearly to its time, if a sample
//! is within half a row.
mod asc;
mod blf;
mod candump;
mod clock;
mod description;
mod frame;
mod frame_table;
mod line;
mod listener;
#[cfg(feature = "mdf")]
mod mdf_frames;
mod settings;
mod signal;
mod survey;

use std::fs::File;
use std::io::Read as _;
use std::path::Path;
use std::sync::Arc;

pub use settings::BusSettings;
pub use survey::{Signals, signals};

use crate::recorded::CampaignError;
use crate::run_columns::{LIFT, LOWER};
use crate::series::Series;
use crate::table::{Cells, Table};
use frame::FrameSink;
use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use line::Ending;
use listener::Listener;

/// A log format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// candump.
    Candump,
    /// Vector ASCII.
    Asc,
    /// Vector binary.
    Blf,
    /// MDF with frames.
    #[cfg(feature = "mdf")]
    Mdf,
    /// Text table with a frame in each row.
    Table,
}

impl Format {
    /// The format by the extension of the file name, and the contents of MDF and tables; `None` for other files.
    pub fn of(path: &Path) -> Option<Self> {
        let end = path.extension()?.to_str()?.to_ascii_lowercase();
        match end.as_str() {
            "log" => Some(Self::Candump),
            "asc" => Some(Self::Asc),
            "blf" => Some(Self::Blf),
            #[cfg(feature = "mdf")]
            "mf4" | "mdf" => mdf_frames::is_one(path).then_some(Self::Mdf),
            "csv" | "txt" => {
                let source = SourceFile::read_any(path).ok()?;
                frame_table::is_one(&source.text).then_some(Self::Table)
            }
            _ => None,
        }
    }

    /// The file: with its text, if the format is one of text.
    ///
    /// # Errors
    /// The file cannot be read, or is not text.
    pub fn source(self, path: &Path) -> Result<SourceFile, CampaignError> {
        match self {
            Self::Candump | Self::Asc | Self::Table => SourceFile::read_any(path),
            Self::Blf => Ok(SourceFile::named(path)),
            #[cfg(feature = "mdf")]
            Self::Mdf => Ok(SourceFile::named(path)),
        }
    }
}

/// Rejects a bus log in an unsupported format.
///
/// # Errors
/// The program that converts it to a supported one.
pub fn check_known(path: &Path) -> Result<(), CampaignError> {
    const FORMATS: [(&[u8], &str, &str); 2] = [
        (
            b";$FILEVERSION",
            "is a PCAN trace of a CAN bus (TRC)",
            "convert it to .asc, for example with python-can: python -m can.logconvert FILE.trc FILE.asc",
        ),
        (
            b"***BUSMASTER",
            "is a log of a CAN bus by BUSMASTER",
            "convert it to .asc with BUSMASTER: Tools, Format Converters, LOG to ASC Conversion",
        ),
    ];
    let is_trace = path
        .extension()
        .is_some_and(|end| end.eq_ignore_ascii_case("trc"));
    let mut begin = Vec::new();
    if let Ok(file) = File::open(path) {
        // A file that cannot be read is refused by its reader.
        let _ = file.take(64).read_to_end(&mut begin);
    }
    let begin = begin.trim_ascii_start();
    let mut formats = FORMATS.into_iter().enumerate();
    let found =
        formats.find(|(index, (mark, ..))| begin.starts_with(mark) || (is_trace && *index == 0));
    match found {
        Some((_, (_, what, hint))) => Err(InputError::of_file(path, what, hint)),
        None => Ok(()),
    }
}

/// Reads a bus log.
///
/// # Errors
/// The first fault, with file, line and column.
pub fn read(
    source: &Arc<SourceFile>,
    format: Format,
    settings: &BusSettings,
) -> Result<Table, CampaignError> {
    let mut listener = settings.listener(source);
    let ending = read_frames(source, format, &mut listener)?;
    let rows = required(source, &listener, settings, LIFT)?;
    required(source, &listener, settings, LOWER)?;
    let series = listener.series();
    let series = series.map(|(column, series)| (column.name, 0, series));
    let cells = match format {
        Format::Candump | Format::Asc | Format::Table => Cells::OneALine,
        Format::Blf => Cells::Nowhere,
        #[cfg(feature = "mdf")]
        Format::Mdf => Cells::Nowhere,
    };
    let table = Table::of_series(source, (0, rows), series, cells)?;
    let table = table.since(listener.origin_s());
    Ok(match ending {
        Ending::Whole => table,
        Ending::CutOff => table.cut_off(),
    })
}

/// Passes the frames of a log to a sink.
fn read_frames(
    source: &SourceFile,
    format: Format,
    sink: &mut dyn FrameSink,
) -> Result<Ending, CampaignError> {
    match format {
        Format::Candump => candump::read(source, sink),
        Format::Asc => asc::read(source, sink),
        Format::Blf => blf::read(source, sink),
        #[cfg(feature = "mdf")]
        Format::Mdf => mdf_frames::read(source, sink),
        Format::Table => frame_table::read(source, sink).map(|()| Ending::Whole),
    }
}

/// A current, which every run requires.
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
                Some(signal) => format!("contains no {signal}, which is assigned to {name}"),
                None => format!("no signal is assigned to {name}"),
            };
            source.error(what, settings.how_to_get(name))
        })
}
