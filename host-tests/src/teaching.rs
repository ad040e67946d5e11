//! Teaching of the controller of a plant, as in service.

use hitch_closed_loop::ClosedLoop;
use hitch_control::commissioning::teach::{Taught, TeachError};
use hitch_effects::find;
use hitch_plant::{AddedEffect, Model};
use hitch_quantities::units::MilliDegreePerSecond;
use hitch_quantities::{Calibration, Inputs, ValidCalibration};

/// The calibration of an untaught machine.
pub fn nominal() -> ValidCalibration {
    Calibration::nominal()
        .validate()
        .expect("the nominal calibration is shipped")
}

/// The dynamic plant with effects of these ids and values.
pub fn dynamic_with(effects: &[(&str, &[f64])]) -> Model {
    let added = effects.iter().map(|(id, values)| AddedEffect {
        effect: find(id).unwrap_or_else(|| panic!("there is no effect {id}")),
        values: values.to_vec(),
    });
    hitch_model_file::dynamic().with_effects(added.collect())
}

/// What valves, oil and seals of this class add to the dynamic plant, and thresholds that are off by so much: hysteresis
/// of 4 % (with dither), 400 N of friction, 1 % of air, and oil that gets thick in the cold.
pub fn typical(lift_shift_a: f64, lower_shift_a: f64) -> Model {
    dynamic_with(&[
        ("lift-threshold-shift", &[lift_shift_a]),
        ("lower-threshold-shift", &[lower_shift_a]),
        ("solenoid-hysteresis", &[0.12]),
        ("coulomb-friction", &[400.0]),
        ("entrained-air", &[0.01, 1.2]),
        ("oil-viscosity", &[0.2, 0.042]),
    ])
}

/// Holds switch and button for `steps`, or until there is a result; returns the result after their release. `tell` can
/// modify the controller's inputs.
pub fn teach_with(
    model: &Model,
    load_kg: f64,
    steps: usize,
    tell: impl Fn(usize, &mut Inputs),
) -> Option<Result<Taught, TeachError>> {
    let mut closed_loop = ClosedLoop::new(model, &nominal(), load_kg, 40.0, 80.0, 21);
    for _ in 0..100 {
        closed_loop.step_with(60.0, |inputs| tell(0, inputs), |_, _| {});
    }
    for step in 0..steps {
        closed_loop.step_with(
            60.0,
            |inputs| {
                inputs.switches.teach = true;
                inputs.jog = Some(MilliDegreePerSecond(1));
                tell(step, inputs);
            },
            |_, _| {},
        );
        if closed_loop.controller().taught().is_some() {
            break;
        }
    }
    for _ in 0..2_000 {
        let sample = closed_loop.step(60.0);
        let currents = (
            sample.outputs.lift_current.0,
            sample.outputs.lower_current.0,
        );
        assert_eq!(currents, (0, 0), "nobody holds the button");
    }
    closed_loop.controller().taught()
}

/// Teaches for up to two minutes.
pub fn teach(model: &Model, load_kg: f64) -> Result<Taught, TeachError> {
    teach_with(model, load_kg, 120_000, |_, _| {}).unwrap_or(Err(TeachError::Aborted))
}

/// The nominal calibration, taught on this plant.
pub fn taught_calibration(model: &Model, load_kg: f64) -> Result<ValidCalibration, TeachError> {
    let taught = teach(model, load_kg)?;
    taught
        .applied_to(&nominal())
        .validate()
        .map_err(|_| TeachError::OutOfRange)
}
