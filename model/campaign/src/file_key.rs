//! A key of a manifest that names a file.

use crate::recorded::CampaignError;
use hitch_input::input_error::quote;
use hitch_input::toml_reader::TomlTable;
use std::path::{Path, PathBuf};

/// The path of the file that `key` names.
///
/// # Errors
/// The file does not exist.
pub fn file_in(dir: &Path, table: &TomlTable<'_>, key: &str) -> Result<PathBuf, CampaignError> {
    let file = file_name(table, key)?;
    let path = dir.join(file);
    if path.exists() {
        return Ok(path);
    }
    let what = if Path::new(file).is_absolute() {
        format!("file {} does not exist", quote(file))
    } else {
        format!("the folder contains no file {}", quote(file))
    };
    let hint = match key {
        "file" => "correct the name, or delete this [[run]] block",
        _ => "correct the name, or delete the line",
    };
    Err(table.error_at(key, what, hint))
}

/// A file's name: a path relative to the campaign's folder, or absolute.
pub fn file_name<'t>(table: &'t TomlTable<'_>, key: &str) -> Result<&'t str, CampaignError> {
    let file = table.required_text(key)?;
    if !file.is_empty() && !file.chars().any(char::is_control) {
        return Ok(file);
    }
    let what = format!("{} is not the name of a file", quote(file));
    let hint = "give a path relative to the campaign's folder, or an absolute path";
    Err(table.error_at(key, what, hint))
}
