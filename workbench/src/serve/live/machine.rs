//! The models and calibrations of the closed loop.

use hitch_plant::Model;
use hitch_quantities::{Calibration, ValidCalibration};

use crate::calibrate::calibrate;
use crate::closed_loop::with_dynamics;
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
        let estimate = &session.fit().estimate;
        Self {
            initial: subject.model.clone(),
            present: rebuilt(&session.model(), estimate, name),
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
