//! Archives of files.

use std::io::{Cursor, Write};

use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::error::Error;

/// An archive of files: name and bytes. It has no times, so that the same content makes the same archive.
///
/// # Errors
/// If the files are too many or too large for an archive, or a name occurs twice.
pub fn zipped(entries: &[(String, &[u8])]) -> Result<Vec<u8>, Error> {
    let made = || {
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in entries {
            writer.start_file(
                name.as_str(),
                SimpleFileOptions::default().unix_permissions(0o755),
            )?;
            writer.write_all(bytes)?;
        }
        Ok::<_, zip::result::ZipError>(writer.finish()?.into_inner())
    };
    made().map_err(|error| Error::Failed(format!("the archive cannot be made: {error}")))
}
