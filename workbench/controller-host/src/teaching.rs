//! Teaching of a machine behind the controller: the result is applied when the button is released.

use hitch_control::commissioning::teach::{Taught, TeachError};
use hitch_controller::Controller;
use hitch_quantities::{Outputs, State, ValidCalibration};

/// Monitors the teaching state.
#[derive(Debug, Clone, Default)]
pub struct Teaching {
    /// Whether teaching is active.
    under_way: bool,
}

impl Teaching {
    /// After a step that ended in `state`: the new calibration, once both coils are off permanently. The controller has
    /// then applied it.
    pub fn follow(
        &mut self,
        controller: &mut Controller,
        state: State,
    ) -> Option<ValidCalibration> {
        let teaches = state == State::Teaching;
        if !std::mem::replace(&mut self.under_way, teaches) || teaches {
            return None;
        }
        let found = controller.taught()?.ok()?;
        // Teaching yields only values within the limits of a calibration.
        let calibration = found.applied_to(controller.calibration()).validate().ok()?;
        controller.recalibrate(calibration.clone());
        Some(calibration)
    }
}

/// The state of the controller after a step as text, with the fault or with the result of teaching.
#[must_use]
pub fn state(outputs: &Outputs, controller: &Controller) -> String {
    match (outputs.fault, outputs.state) {
        (Some(fault), state) => format!("{}:{}", state.name(), fault.name()),
        (None, State::Teaching) => result(controller.taught()),
        (None, state) => state.name().to_owned(),
    }
}

/// The state while the teach button is held.
fn result(result: Option<Result<Taught, TeachError>>) -> String {
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
