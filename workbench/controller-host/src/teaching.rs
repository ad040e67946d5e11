//! Teaching a machine behind the controller: what is found is taken up once the button is let go.

use hitch_control::commissioning::teach::{Taught, TeachError};
use hitch_controller::Controller;
use hitch_quantities::{Outputs, State, ValidCalibration};

/// Watches whether the machine has been taught.
#[derive(Debug, Clone, Default)]
pub struct Teaching {
    /// Whether it is being taught.
    under_way: bool,
}

impl Teaching {
    /// After a step that ended in `state`: what was found, once both coils are off for good. The controller has then
    /// taken it up.
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
        // Found within limits that a calibration may have anyway.
        let calibration = found.applied_to(controller.calibration()).validate().ok()?;
        controller.recalibrate(calibration.clone());
        Some(calibration)
    }
}

/// What the controller says of itself after a step: its state, with the fault, or with the result of teaching.
#[must_use]
pub fn state(outputs: &Outputs, controller: &Controller) -> String {
    match (outputs.fault, outputs.state) {
        (Some(fault), state) => format!("{}:{}", state.name(), fault.name()),
        (None, State::Teaching) => result(controller.taught()),
        (None, state) => state.name().to_owned(),
    }
}

/// What a machine says of itself as long as the button is held that teaches it.
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
