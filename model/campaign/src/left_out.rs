//! Formats that a build may leave out, as their readers take a third of its time.

use std::path::Path;

use hitch_input::file_kind::{first_bytes, is_mdf, is_parquet};
use hitch_input::source_file::SourceFile;

use crate::recorded::CampaignError;

/// Refuses a file of a format that this build does not read, by its first bytes.
///
/// # Errors
/// It is of such a format.
pub fn check(path: &Path) -> Result<(), CampaignError> {
    let formats = [
        (
            "MDF",
            "mdf",
            cfg!(feature = "mdf"),
            is_mdf as fn(&[u8]) -> bool,
        ),
        ("Parquet", "parquet", cfg!(feature = "parquet"), is_parquet),
    ];
    let is_one =
        |is_format: fn(&[u8]) -> bool| first_bytes(path).is_some_and(|bytes| is_format(&bytes));
    let left_out = formats
        .into_iter()
        .find(|(_, _, is_read, is_format)| !is_read && is_one(*is_format));
    let Some((format, feature, ..)) = left_out else {
        return Ok(());
    };
    let what = format!("is {format}, which this build of hitch does not read");
    let hint = format!("build hitch with `--features {feature}`, or export the log as CSV");
    Err(SourceFile::named(path).error(what, hint))
}
