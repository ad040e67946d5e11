//! The models and calibrations of the closed loop.

use hitch_plant::{LinkageError, Model};
use hitch_quantities::{Calibration, ValidCalibration};

use super::orders::Orders;
use crate::calibrate::{CalibrateError, calibrate};
use crate::closed_loop::with_dynamics;

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

impl Machine {
    /// The angle of the lever, within the travel of the hitch, degree.
    #[must_use]
    pub fn start_deg(&self, orders: &Orders) -> f64 {
        let (low_rad, high_rad) = self.plant.linkage().swing_rad();
        orders
            .lever_deg
            .clamp(low_rad.to_degrees(), high_rad.to_degrees())
    }
}

/// The reason why models have no closed loop.
#[derive(Debug, thiserror::Error)]
pub enum MachineError {
    /// The linkage of the plant cannot be assembled.
    #[error("the model has no linkage: {0}")]
    NoLinkage(#[from] LinkageError),
    /// A model cannot be converted into a calibration.
    #[error("no calibration for {model}: {reason}")]
    NoCalibration {
        /// Name of the model.
        model: String,
        /// Reason.
        reason: CalibrateError,
    },
}

/// The calibration of a model, with the firmware's values for what the model does not tell.
///
/// # Errors
/// If the model cannot be converted.
pub fn calibration(model: &Model) -> Result<ValidCalibration, MachineError> {
    calibrate(model, &Calibration::nominal()).map_err(|reason| MachineError::NoCalibration {
        model: model.name.clone(),
        reason,
    })
}

/// The models from which a machine is built.
#[derive(Debug, Clone)]
pub struct Models {
    initial: Model,
    present: Model,
}

impl Models {
    /// The initial and the present model.
    #[must_use]
    pub const fn new(initial: Model, present: Model) -> Self {
        Self { initial, present }
    }

    /// The calibration of the present model.
    ///
    /// # Errors
    /// If the model cannot be converted.
    pub fn rebuilt(&self) -> Result<ValidCalibration, MachineError> {
        calibration(&self.present)
    }

    /// Converts both models.
    ///
    /// # Errors
    /// If a model cannot be converted.
    pub fn machine(&self) -> Result<Machine, MachineError> {
        Ok(Machine {
            plant: with_dynamics(&self.present)?,
            initial: calibration(&self.initial)?,
            rebuilt: self.rebuilt()?,
        })
    }
}
