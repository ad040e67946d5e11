//! The models and calibrations of the closed loop.

use hitch_plant::Model;
use hitch_quantities::ValidCalibration;

use crate::closed_loop::with_dynamics;
use crate::error::Error;
use crate::serve::tuned::calibration;

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
    /// The initial and the present model.
    pub const fn new(initial: Model, present: Model) -> Self {
        Self { initial, present }
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
