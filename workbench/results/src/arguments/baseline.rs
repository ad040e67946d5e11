//! The option `--baseline`.

use std::path::{Path, PathBuf};

use hitch_output::targets::campaign_files;
use hitch_output::text::shell_word;

/// Selects the baseline of a command.
#[derive(Debug, Clone, Default, clap::Args)]
pub struct BaselineArg {
    /// Folder of the campaign that the model was adopted from: what the model leaves on it is subtracted, so that only
    /// changes since then remain
    #[arg(long, value_name = "CAMPAIGN")]
    baseline: Option<PathBuf>,
}

impl BaselineArg {
    /// The folder of the baseline, if one is named.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        self.baseline.as_deref()
    }

    /// The files of the baseline, if one is named.
    #[must_use]
    pub fn files(&self) -> Vec<PathBuf> {
        self.baseline.as_deref().map_or(Vec::new(), campaign_files)
    }

    /// The option as written on a command line; empty without a baseline.
    #[must_use]
    pub fn written(&self) -> String {
        match &self.baseline {
            None => String::new(),
            Some(folder) => format!(" --baseline {}", shell_word(folder)),
        }
    }
}
