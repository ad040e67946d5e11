//! The folder of a campaign: its manifest, and the files that it names.

use hitch_input::input_error::{InputError, quote};
use hitch_input::source_file::SourceFile;
use hitch_input::toml_reader::TomlTable;
use std::path::{Path, PathBuf};

/// The manifest in a folder.
///
/// # Errors
/// The folder has none, or it cannot be read.
pub fn manifest_of(dir: &Path) -> Result<SourceFile, InputError> {
    let hint = "a campaign is a folder with campaign.toml and a log per run";
    if !dir.exists() {
        return Err(InputError::of_file(dir, "no such folder", hint));
    }
    if !dir.is_dir() {
        return Err(InputError::of_file(dir, "is not a folder", hint));
    }
    let path = dir.join("campaign.toml");
    if !path.exists() {
        return Err(InputError::of_file(dir, "contains no campaign.toml", hint));
    }
    SourceFile::read(&path)
}

/// The name of a folder, for a campaign that has none.
#[must_use]
pub fn folder_name(dir: &Path) -> String {
    let full = dir.canonicalize().unwrap_or_else(|_| dir.to_path_buf());
    let name = full.file_name().map(|name| name.to_string_lossy());
    name.map_or_else(|| "campaign".to_owned(), Into::into)
}

/// The path of the file that `key` names.
///
/// # Errors
/// The file does not exist.
pub fn file_in(dir: &Path, table: &TomlTable<'_>, key: &str) -> Result<PathBuf, InputError> {
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
///
/// # Errors
/// The text is empty or has control characters.
pub fn file_name<'t>(table: &'t TomlTable<'_>, key: &str) -> Result<&'t str, InputError> {
    let file = table.required_text(key)?;
    if !file.is_empty() && !file.chars().any(char::is_control) {
        return Ok(file);
    }
    let what = format!("{} is not the name of a file", quote(file));
    let hint = "give a path relative to the campaign's folder, or an absolute path";
    Err(table.error_at(key, what, hint))
}
