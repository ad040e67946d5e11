//! The calibration of a machine that has the sensors of draft and slip control.

use hitch_quantities::units::{Count, PerMille};
use hitch_quantities::{Calibration, CalibrationError, ValidCalibration};

/// The calibration is invalid with the functions on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the calibration is invalid with all functions on: {0:?}")]
pub struct NotFitted(CalibrationError);

/// A calibration with draft pins, slip guard and ride damping, whose other values are kept, and further changes.
///
/// # Errors
/// If it is not valid.
pub fn fitted(
    calibration: &ValidCalibration,
    change: impl FnOnce(&mut Calibration),
) -> Result<ValidCalibration, NotFitted> {
    let mut fitted = (**calibration).clone();
    fitted.draft.fitted = Count(1);
    fitted.ride.fitted = Count(1);
    if fitted.slip.highest_limit == PerMille(0) {
        fitted.slip.highest_limit = PerMille(300);
    }
    change(&mut fitted);
    fitted.seal().map_err(NotFitted)
}
