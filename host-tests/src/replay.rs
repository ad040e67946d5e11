//! Runs recorded inputs through the controller on the host.

use hitch_controller::Controller;
use hitch_quantities::signals::{INPUT_BYTES, OUTPUT_BYTES};
use hitch_quantities::{Inputs, Outputs};

use crate::teaching::nominal;

/// The controller at power-up, with the nominal calibration: as in the image.
pub fn controller() -> Controller {
    Controller::new(nominal())
}

/// The outputs of each step, from power-up on, with the nominal calibration.
pub fn replay(inputs: &[[u8; INPUT_BYTES]]) -> Vec<Outputs> {
    let mut controller = controller();
    inputs
        .iter()
        .map(|record| controller.step(&Inputs::from_bytes(record)))
        .collect()
}

/// Where two runs first differ, in words; `None` if they don't.
pub fn first_difference(
    inputs: &[[u8; INPUT_BYTES]],
    host: &[Outputs],
    target: &[[u8; OUTPUT_BYTES]],
) -> Option<String> {
    if host.len() != target.len() {
        return Some(format!(
            "the host ran {} steps, the target {}",
            host.len(),
            target.len()
        ));
    }
    let step = host
        .iter()
        .zip(target)
        .position(|(host, target)| host.to_bytes() != *target)?;
    Some(format!(
        "step {step} of {}\ninputs: {:?}\nhost:   {:?}\n        {:?}\ntarget: {:?}",
        host.len(),
        Inputs::from_bytes(&inputs[step]),
        host[step],
        host[step].to_bytes(),
        target[step],
    ))
}
