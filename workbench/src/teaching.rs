//! Teaching of a machine behind `hitch controller`: the result is applied when the button is released, and saved.

use std::path::PathBuf;

use hitch_control::commissioning::teach::{Taught, TeachError};
use hitch_controller::Controller;
use hitch_quantities::State;

use crate::error::Error;
use crate::{calibration_file, output};

/// Monitors the teaching state.
#[derive(Debug, Default)]
pub struct Teaching {
    /// Output file of the calibration.
    out: Option<PathBuf>,
    /// Whether teaching is active.
    under_way: bool,
}

impl Teaching {
    /// With an output file for the result.
    #[must_use]
    pub fn new(out: Option<PathBuf>) -> Self {
        Self {
            out,
            under_way: false,
        }
    }

    /// After a step that ended in `state`: the controller applies the result once both coils are off permanently.
    ///
    /// # Errors
    /// If the file cannot be written.
    pub fn follow(&mut self, controller: &mut Controller, state: State) -> Result<(), Error> {
        let teaches = state == State::Teaching;
        if !std::mem::replace(&mut self.under_way, teaches) || teaches {
            return Ok(());
        }
        let Some(Ok(found)) = controller.taught() else {
            return Ok(());
        };
        // Teaching yields only values within the limits of a calibration.
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

/// The machine's answers while the teach button is held.
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
