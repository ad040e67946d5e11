//! What can go wrong while the program runs, and the exit code that says so.

use std::io;
use std::path::PathBuf;
use std::process::ExitCode;

use hitch_input::input_error::InputError;

/// Why a command stopped. Every message is one line: what, where, how to mend it.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A file that somebody wrote is wrong.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The command line is wrong.
    #[error("{0}")]
    Usage(String),
    /// A file could not be written.
    #[error("{}: cannot be written: {source}; name a file in a folder that exists and is yours", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Standard output could not be written.
    #[error("standard output cannot be written: {0}")]
    Stdout(#[source] io::Error),
    /// Something that is nobody's input went wrong.
    #[error("{0}")]
    Failed(String),
}

impl Error {
    /// 2 for wrong usage or bad input, 1 for anything else.
    ///
    /// A reader that has seen enough (`hitch effects | head -1`) is no fault: 0.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Stdout(error) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
            Self::Input(_) | Self::Usage(_) | Self::Write { .. } => ExitCode::from(2),
            Self::Stdout(_) | Self::Failed(_) => ExitCode::from(1),
        }
    }

    /// True if there is nothing to say about it.
    pub fn is_silent(&self) -> bool {
        matches!(self, Self::Stdout(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}
