//! The archive of a unit.

use std::io::{Cursor, Write};

use hitch_fmu::content::{Content, Kind};
use hitch_fmu::version::Version;
use hitch_input::source_file::SourceFile;
use zip::ZipWriter;
use zip::result::ZipError;
use zip::write::SimpleFileOptions;

use super::library::platform;
use crate::error::Error;

/// The bytes of a unit of a version of the standard with the content of `file` and the `library`.
///
/// # Errors
/// If the file is wrong, or the standard has no name for this machine.
pub fn archive(
    version: Version,
    kind: Kind,
    file: &SourceFile,
    library: &[u8],
) -> Result<Vec<u8>, Error> {
    let content = Content::parse(version, kind, file)?;
    let (platform, suffix) = platform(version)?;
    let binary = format!("binaries/{platform}/{}{suffix}", kind.identifier());
    let entries = [
        (
            "modelDescription.xml".to_owned(),
            content.description.as_bytes(),
        ),
        (format!("resources/{}", kind.file()), file.text.as_bytes()),
        (binary, library),
    ];
    zipped(&entries).map_err(|error| Error::Failed(format!("the archive cannot be made: {error}")))
}

/// An archive of files: name and bytes. It has no times, so that the same content makes the same archive.
fn zipped(entries: &[(String, &[u8])]) -> Result<Vec<u8>, ZipError> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, bytes) in entries {
        writer.start_file(
            name.as_str(),
            SimpleFileOptions::default().unix_permissions(0o755),
        )?;
        writer.write_all(bytes)?;
    }
    Ok(writer.finish()?.into_inner())
}
