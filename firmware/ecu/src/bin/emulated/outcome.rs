//! What a run of the image did, and why it ended.

use hitch_quantities::CalibrationError;

use crate::host_file::HostFileError;

/// Why the image ends early.
pub enum Failure {
    HostFile(HostFileError),
    Calibration,
}

impl From<CalibrationError> for Failure {
    fn from(_: CalibrationError) -> Self {
        Self::Calibration
    }
}

impl From<HostFileError> for Failure {
    fn from(error: HostFileError) -> Self {
        Self::HostFile(error)
    }
}

/// What was done.
#[derive(Default)]
pub struct Done {
    /// Steps or milliseconds.
    pub ticks: u32,
    /// The longest of them, in ticks of the stopwatch, apart from those that a field below counts.
    pub longest: u32,
    /// The longest of those with a coil on.
    pub longest_working: u32,
    /// The longest of those in which a calibration is stored.
    pub longest_storing: u32,
    /// The longest way from the sampled codes to the pulses, the controller's step in it.
    pub longest_control: u32,
}
