//! The option `--next`: the proposed next experiment as files for a test stand.

use std::path::PathBuf;

use hitch_output::error::Error;
use hitch_results::explanation::{Next, planned_files};

/// The option `--next`.
#[derive(Debug, clap::Args)]
pub struct NextFolder {
    /// Write the proposed next experiment to this new folder: the currents of each run over time, and a campaign.toml for its logs
    #[arg(long, value_name = "FOLDER")]
    next: Option<PathBuf>,
}

impl NextFolder {
    /// Checks the folder before a computation.
    ///
    /// # Errors
    /// If it is not writable, or has files already.
    pub fn check(&self) -> Result<(), Error> {
        match &self.next {
            Some(folder) => hitch_output::check_new_folder("--next", folder),
            None => Ok(()),
        }
    }

    /// Whether the option was given.
    pub fn is_given(&self) -> bool {
        self.next.is_some()
    }

    /// Writes the experiment, and says what was written.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(&self, next: &Next) -> Result<String, Error> {
        let Some(folder) = &self.next else {
            return Ok(String::new());
        };
        let place = folder.display();
        let Some(proposal) = &next.proposal else {
            return Ok(format!(
                "No manoeuvre is proposed; {place} was not written.\n"
            ));
        };
        hitch_output::create_folder(&folder.join("currents"))?;
        for (name, text) in planned_files(proposal) {
            hitch_output::write_file(&folder.join(name), text.as_bytes())?;
        }
        Ok(format!(
            "The currents of the next experiment are in {place}; save the logs there as campaign.toml states.\n"
        ))
    }
}
