//! What teaching finds on a machine behind `hitch controller`: taken up once the button is let go, and kept in a file.

use std::path::PathBuf;

use hitch_control::commissioning::teach::{Taught, TeachError};
use hitch_controller::Controller;
use hitch_quantities::State;

use crate::error::Error;
use crate::{calibration_file, output};

/// Watches whether the machine has been taught.
#[derive(Debug, Default)]
pub struct Teaching {
    /// Where the calibration goes.
    out: Option<PathBuf>,
    /// Whether it is being taught.
    under_way: bool,
}

impl Teaching {
    /// With a file for what is found.
    #[must_use]
    pub fn new(out: Option<PathBuf>) -> Self {
        Self {
            out,
            under_way: false,
        }
    }

    /// After a step that ended in `state`: the controller takes up what was found once both coils are off for good.
    ///
    /// # Errors
    /// If the file can't be written.
    pub fn follow(&mut self, controller: &mut Controller, state: State) -> Result<(), Error> {
        let teaches = state == State::Teaching;
        if !std::mem::replace(&mut self.under_way, teaches) || teaches {
            return Ok(());
        }
        let Some(Ok(found)) = controller.taught() else {
            return Ok(());
        };
        // Found within limits that a calibration may have anyway.
        let Ok(calibration) = found.applied_to(controller.calibration()).validate() else {
            return Ok(());
        };
        if let Some(path) = &self.out {
            output::write_file(path, calibration_file::write(&calibration).as_bytes())?;
        }
        controller.recalibrate(calibration);
        Ok(())
    }
}

/// What a machine says of itself as long as the button is held that teaches it.
#[must_use]
pub fn state(result: Option<Result<Taught, TeachError>>) -> String {
    let reason = match result {
        None => return State::Teaching.name().to_owned(),
        Some(Ok(_)) => return "taught".to_owned(),
        Some(Err(TeachError::Aborted)) => "aborted",
        Some(Err(TeachError::NoMotion)) => "no-motion",
        Some(Err(TeachError::OutOfRange)) => "threshold-too-far-off",
        Some(Err(TeachError::Spread)) => "ramps-differ",
        Some(Err(TeachError::Ends)) => "ends-do-not-fit",
    };
    format!("not-taught:{reason}")
}
