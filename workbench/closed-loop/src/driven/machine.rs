//! The models and calibrations of the closed loop.

use hitch_plant::{LinkageError, Model};
use hitch_quantities::units::{Count, MilliDegree};
use hitch_quantities::{Calibration, ValidCalibration};

use super::orders::Orders;
use crate::calibrate::{CalibrateError, calibrate};
use crate::closed_loop::with_dynamics;
use crate::field::{NotFitted, OutOfReach, TOUCH_DEG, check_reach, fitted};

/// The plant, and both calibrations.
#[derive(Debug, Clone)]
pub struct Machine {
    /// The plant of both hitches.
    pub plant: Model,
    /// The calibration of the initial model.
    pub initial: ValidCalibration,
    /// The calibration of the present model.
    pub rebuilt: ValidCalibration,
    /// Both with the sensors for the work on a field, or why the machine cannot work on it.
    pub working: Result<[ValidCalibration; 2], NoField>,
}

/// The calibrations of a hitch.
#[derive(Debug, Clone, Copy)]
pub struct Calibrations<'c> {
    /// Of its model.
    pub plain: &'c ValidCalibration,
    /// The same with the sensors for the work on a field, if the machine can work there.
    pub working: Option<&'c ValidCalibration>,
}

/// Why a machine cannot work on a field.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoField {
    /// The links are too short.
    #[error(transparent)]
    OutOfReach(#[from] OutOfReach),
    /// A calibration is not valid with the sensors.
    #[error(transparent)]
    NotFitted(#[from] NotFitted),
}

impl Machine {
    /// Both calibrations of each hitch: that of the initial, and that of the present model.
    pub(super) fn calibrations(&self) -> [Calibrations<'_>; 2] {
        let working = self.working.as_ref().ok();
        let both = |plain, at: usize| Calibrations {
            plain,
            working: working.map(|working| &working[at]),
        };
        [both(&self.initial, 0), both(&self.rebuilt, 1)]
    }

    /// Why the machine cannot follow orders; `None` if it can.
    #[must_use]
    pub fn refusal(&self, orders: &Orders) -> Option<String> {
        let reason = self.working.as_ref().err();
        reason
            .filter(|_| orders.field.is_some())
            .map(ToString::to_string)
    }

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
        let (plant, initial) = (with_dynamics(&self.present)?, calibration(&self.initial)?);
        let rebuilt = self.rebuilt()?;
        let working = working(&plant, [&initial, &rebuilt]);
        Ok(Machine {
            plant,
            initial,
            rebuilt,
            working,
        })
    }
}

/// Calibrations with all sensors of the field.
fn working(
    plant: &Model,
    [initial, rebuilt]: [&ValidCalibration; 2],
) -> Result<[ValidCalibration; 2], NoField> {
    check_reach(plant)?;
    let with_sensors = |calibration| {
        fitted(calibration, |changed| {
            changed.depth.fitted = Count(1);
            if changed.work.angle == MilliDegree(0) {
                changed.work.angle = MilliDegree((TOUCH_DEG * 1e3) as i32);
            }
        })
    };
    Ok([with_sensors(initial)?, with_sensors(rebuilt)?])
}
