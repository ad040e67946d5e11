//! Measurement campaigns: a campaign is a folder with `campaign.toml` and one log per run.
//!
//! ```text
//! campaign.toml        format, name, noise of the instruments, and a [[run]] block a log
//! lift_1.5A_050kg.csv  time_s, lift_current_a, lower_current_a and the measured channels; or
//! monday.log, .asc, .blf  log of the ECU's bus by candump or a tool of Vector's; or
//! bench.csv, .mf4, .mat, .parquet  log of any other logger, mapped by `[columns]`
//! ```
//!
//! Reading validates everything that does not need a model, so that later code need not: every number is finite and
//! plausible, time increases strictly, the currents have no gaps, and every run has at least one measured channel.
//!
//! A [`Campaign`] has [`Run`]s, each on a [`Bench`]; a [`CampaignError`] says where a file is wrong. What a log holds before
//! it is mapped is a [`Survey`](survey::Survey).
#![forbid(unsafe_code)]

mod bus_log;
mod cell_error;
mod channel_log;
mod columns;
mod contents;
mod csv_log;
mod cut;
mod dropout;
pub mod folder;
mod ideal_times;
mod left_out;
mod manifest;
#[cfg(feature = "mdf")]
mod mdf_log;
mod number_log;
mod own_rate;
mod recorded;
mod run_columns;
mod run_log;
mod scale;
mod series;
pub mod survey;
mod table;
mod time_base;

pub use recorded::{Bench, Campaign, CampaignError, Noise, Run};
pub use table::{ClockStep, LogNotes};

use std::path::{Path, PathBuf};

use hitch_input::source_file::SourceFile;
use hitch_plant::Linkage;

impl Campaign {
    /// Reads a campaign's folder. An angle logged as cylinder travel is converted with the nominal linkage.
    ///
    /// # Errors
    /// The first fault, with file, line and column: see the module's description.
    pub fn load(dir: &Path) -> Result<Self, CampaignError> {
        manifest::load(dir, scale::nominal_linkage())
    }

    /// Reads the folder of a campaign with a hitch of this linkage.
    ///
    /// # Errors
    /// As [`Campaign::load`].
    pub fn load_with(dir: &Path, linkage: &Linkage) -> Result<Self, CampaignError> {
        manifest::load(dir, linkage)
    }

    /// The logs and the DBC that the manifest in a folder refers to, in any folder.
    ///
    /// # Errors
    /// The manifest cannot be parsed.
    pub fn files(dir: &Path) -> Result<Vec<PathBuf>, CampaignError> {
        manifest::files(dir)
    }

    /// Reads the campaign of a folder with this text as its manifest, for a hitch with this linkage.
    ///
    /// # Errors
    /// As [`Campaign::load`].
    pub fn of_manifest(dir: &Path, text: &str, linkage: &Linkage) -> Result<Self, CampaignError> {
        let read = manifest::read(dir, &of_text(dir, text), linkage, table::LONGEST_STEP_S);
        read.map(|(campaign, _)| campaign)
    }

    /// The same, whose logs are not yet cut into runs: their clocks may be set. What a reader of each log should know.
    ///
    /// # Errors
    /// As [`Campaign::load`].
    pub fn uncut(
        dir: &Path,
        text: &str,
        linkage: &Linkage,
    ) -> Result<(Self, Vec<LogNotes>), CampaignError> {
        manifest::read(dir, &of_text(dir, text), linkage, f64::INFINITY)
    }

    /// Whether the log of each run of a manifest's text continues that of the run before it: the same columns, and times
    /// that continue. Such logs belong to one recording.
    ///
    /// # Errors
    /// As [`Campaign::load`].
    pub fn continued(
        dir: &Path,
        text: &str,
        linkage: &Linkage,
    ) -> Result<Vec<bool>, CampaignError> {
        manifest::continued(dir, &of_text(dir, text), linkage)
    }
}

/// The text of a manifest in a folder.
fn of_text(dir: &Path, text: &str) -> SourceFile {
    SourceFile {
        path: dir.join("campaign.toml"),
        text: text.to_owned(),
    }
}

impl Run {
    /// Reads a single log without a campaign; it may contain only currents. A bus log has to be from the project's ECU.
    ///
    /// # Errors
    /// The first fault, with file, line and column.
    pub fn read(path: &Path, bench: Bench, oil_temperature_c: f64) -> Result<Self, CampaignError> {
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let table = run_log::table(path, run_log::Settings::default())?;
        run_log::run(
            &table,
            &file,
            cut::Cut::NONE,
            bench,
            Some(oil_temperature_c),
            table::LONGEST_STEP_S,
        )
    }
}
