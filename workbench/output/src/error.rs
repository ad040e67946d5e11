//! Errors of the program, and their exit codes.

use std::io;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use hitch_closed_loop::driven::MachineError;
use hitch_input::input_error::InputError;

/// The reason why a command stopped. Every message is one line: what, where, suggested correction.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// An input file is invalid.
    #[error(transparent)]
    Input(#[from] InputError),
    /// The command line is invalid.
    #[error("{0}")]
    Usage(String),
    /// A file could not be written.
    #[error("{}: cannot be written: {source}; give a file in an existing, writable folder", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Cause.
        source: io::Error,
    },
    /// Standard output could not be written.
    #[error("standard output cannot be written: {0}")]
    Stdout(#[source] io::Error),
    /// Any failure that is not caused by an input.
    #[error("{0}")]
    Failed(String),
}

impl From<MachineError> for Error {
    fn from(error: MachineError) -> Self {
        match error {
            MachineError::NoLinkage(_) => Self::Failed(error.to_string()),
            MachineError::NoCalibration { .. } => Self::Usage(error.to_string()),
        }
    }
}

impl Error {
    /// A file that could not be written, for its cause.
    pub fn writing(path: &Path) -> impl Fn(io::Error) -> Self {
        move |source| Self::Write {
            path: path.to_path_buf(),
            source,
        }
    }

    /// 2 for invalid usage or input, 1 for other errors.
    ///
    /// A closed pipe (`hitch effects | head -1`) is not an error: 0.
    pub fn exit_code(&self) -> ExitCode {
        match self {
            Self::Stdout(error) if error.kind() == io::ErrorKind::BrokenPipe => ExitCode::SUCCESS,
            Self::Input(_) | Self::Usage(_) | Self::Write { .. } => ExitCode::from(2),
            Self::Stdout(_) | Self::Failed(_) => ExitCode::from(1),
        }
    }

    /// Whether there is no message to print.
    pub fn is_silent(&self) -> bool {
        matches!(self, Self::Stdout(error) if error.kind() == io::ErrorKind::BrokenPipe)
    }
}
