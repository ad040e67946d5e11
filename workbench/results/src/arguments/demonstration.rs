//! The demonstration campaign, compiled into the program, so that it needs no files.

use hitch_campaign::Campaign;
use include_dir::{Dir, include_dir};

use hitch_output::error::Error;

static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/../data/demonstration");

/// Reads the shipped campaign.
///
/// # Errors
/// If the temporary folder for the unpacked campaign cannot be written.
pub fn campaign() -> Result<Campaign, Error> {
    let unpacked = |error: std::io::Error| {
        Error::Failed(format!("the shipped campaign cannot be unpacked: {error}"))
    };
    let folder = tempfile::tempdir().map_err(unpacked)?;
    FILES.extract(folder.path()).map_err(unpacked)?;
    Ok(Campaign::load(folder.path())?)
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_shipped_campaign_is_sound() {
        let campaign = super::campaign().unwrap();
        assert_eq!(
            (campaign.name.as_str(), campaign.runs.len()),
            ("demonstration", 11)
        );
    }
}
