//! The archive of a unit.

use hitch_fmu::content::Content;
use hitch_fmu::kind::Kind;
use hitch_input::source_file::SourceFile;

use super::library::platform;
use hitch_output::archive::zipped;
use hitch_output::error::Error;

/// The bytes of a unit with the content of `file` and the `library`.
///
/// # Errors
/// If the file is wrong, or the standard has no name for this machine.
pub fn archive(kind: Kind, file: &SourceFile, library: &[u8]) -> Result<Vec<u8>, Error> {
    let content = Content::parse(kind, file)?;
    let (platform, suffix) = platform()?;
    let binary = format!("binaries/{platform}/{}{suffix}", kind.identifier());
    let entries = [
        (
            "modelDescription.xml".to_owned(),
            content.description.as_bytes(),
        ),
        (format!("resources/{}", kind.file()), file.text.as_bytes()),
        (binary, library),
    ];
    zipped(&entries)
}
