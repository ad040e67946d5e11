//! The models and calibrations of the closed loop.

use hitch_model_file::dynamic;
use hitch_plant::{Constants, Dynamics, Model, OrificeValve};
use hitch_quantities::{Calibration, ValidCalibration};

use crate::calibrate::calibrate;
use crate::error::Error;
use crate::explanation::rebuilt;
use crate::serve::session::Session;

/// The plant, and both calibrations.
#[derive(Debug, Clone)]
pub struct Machine {
    /// The plant of both hitches.
    pub plant: Model,
    /// The calibration of the initial model.
    pub initial: ValidCalibration,
    /// The calibration of the present model.
    pub rebuilt: ValidCalibration,
}

/// The models from which a machine is built.
#[derive(Debug, Clone)]
pub struct Models {
    initial: Model,
    present: Model,
}

impl Models {
    /// The models of a session.
    pub fn of(session: &Session) -> Self {
        let subject = session.subject();
        let name = format!("{}-{}", subject.model.name, subject.experiment().name);
        let effects = &session.fit().estimate.effects;
        Self {
            initial: subject.model.clone(),
            present: rebuilt(&session.model(), effects, name),
        }
    }

    /// The calibration of the present model.
    ///
    /// # Errors
    /// If the model cannot be converted.
    pub fn rebuilt(&self) -> Result<ValidCalibration, Error> {
        calibration(&self.present)
    }

    /// Converts both models.
    ///
    /// # Errors
    /// If a model cannot be converted.
    pub fn machine(&self) -> Result<Machine, Error> {
        Ok(Machine {
            plant: with_dynamics(&self.present)?,
            initial: calibration(&self.initial)?,
            rebuilt: self.rebuilt()?,
        })
    }
}

fn calibration(model: &Model) -> Result<ValidCalibration, Error> {
    calibrate(model, &Calibration::nominal())
        .map_err(|error| Error::Usage(format!("no calibration for {}: {error}", model.name)))
}

/// A quasi-static model with its declared inertia, compressibility and spool lag; a dynamic one unchanged.
fn with_dynamics(model: &Model) -> Result<Model, Error> {
    let constants = model.constants();
    if constants.dynamics == Dynamics::Dynamic {
        return Ok(model.clone());
    }
    let laminar = |valve: &OrificeValve, declared: &OrificeValve| OrificeValve {
        transition_drop_pa: valve.transition_drop_pa.max(declared.transition_drop_pa),
        ..valve.clone()
    };
    let declared = dynamic();
    let (lift, lower) = (
        &declared.constants().lift_valve,
        &declared.constants().lower_valve,
    );
    let constants = Constants {
        dynamics: Dynamics::Dynamic,
        lift_valve: laminar(&constants.lift_valve, lift),
        lower_valve: laminar(&constants.lower_valve, lower),
        ..constants.clone()
    };
    let failed = |error| Error::Failed(format!("the model has no linkage: {error}"));
    model.with_constants(constants).map_err(failed)
}
