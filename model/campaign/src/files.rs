//! The files that a campaign's manifest refers to.

use std::path::{Path, PathBuf};

use hitch_input::source_file::SourceFile;
use hitch_input::toml_reader::TomlTable;

use crate::CampaignError;
use crate::manifest::THEN;

/// The logs and the DBC that the manifest in a folder refers to, in any folder.
///
/// # Errors
/// The manifest cannot be parsed.
pub fn named(dir: &Path) -> Result<Vec<PathBuf>, CampaignError> {
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
