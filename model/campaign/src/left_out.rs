//! Formats that a build may leave out, as their readers take a third of its time.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use hitch_input::file_kind::{is_mdf, is_parquet};
use hitch_input::source_file::SourceFile;

use crate::recorded::CampaignError;

/// Refuses a file of a format that this build does not read, by its first bytes.
///
/// # Errors
/// It is of such a format.
pub fn check(path: &Path) -> Result<(), CampaignError> {
    let mut bytes = [0; 16];
    let is_long = File::open(path).is_ok_and(|mut file| file.read_exact(&mut bytes).is_ok());
    let (format, feature) = match &bytes {
        bytes if !cfg!(feature = "mdf") && is_mdf(bytes) => ("MDF", "mdf"),
        bytes if !cfg!(feature = "parquet") && is_parquet(bytes) => ("Parquet", "parquet"),
        _ => return Ok(()),
    };
    if !is_long {
        return Ok(());
    }
    let what = format!("is {format}, which this build of hitch does not read");
    let hint = format!("build hitch with `--features {feature}`, or export the log as CSV");
    Err(SourceFile::named(path).error(what, hint))
}
