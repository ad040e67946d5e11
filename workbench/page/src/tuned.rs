//! A calibration tuned for the model of a step.

use std::ops::ControlFlow;
use std::sync::Arc;

use hitch_controller_host::calibration_file;
use hitch_plant::Model;

use hitch_closed_loop::driven::calibration;
use hitch_output::error::Error;
use hitch_results::closed_loop::{OIL_TEMPERATURE_C, Scenario, presses};
use hitch_results::comparison::Evaluated;
use hitch_results::tuning::figures::Figure;
use hitch_results::tuning::{Change, Trial};

/// A tuned calibration with its figures beside those of the calibration of the model.
#[derive(Debug)]
pub struct TunedFor {
    /// The model.
    pub of: Arc<Evaluated>,
    /// The calibration file.
    pub text: String,
    /// The changed values.
    pub changes: Vec<Change>,
    /// The figures, with their limits.
    pub figures: Vec<Figure>,
}

impl TunedFor {
    /// Searches with at most `trials` candidates, as `hitch tune` does. `tell` is called after each candidate with their number
    /// so far and the best cost; the search ends with its best so far when it answers `Break`.
    ///
    /// # Errors
    /// If the model cannot be converted, or no candidate is valid.
    pub fn search(
        of: Arc<Evaluated>,
        model: &Model,
        trials: usize,
        tell: impl Fn(usize, f64) -> ControlFlow<()> + Sync,
    ) -> Result<Self, Error> {
        let base = calibration(model)?;
        let moves = Scenario::Tuning.moves(model, None);
        let presses = presses(model, &base, None, &[OIL_TEMPERATURE_C]);
        let trial = Trial::new(model, &moves, &presses);
        let failed = || Error::Failed("the search found no valid calibration".to_owned());
        let before = trial.judge(&base).ok_or_else(failed)?;
        let after = trial.search(&base, &[], trials, tell).ok_or_else(failed)?;
        Ok(Self {
            of,
            text: calibration_file::write_tuned(&after.calibration, &base),
            changes: trial.changes(&before.calibration, &after.calibration),
            figures: before.compared(&after),
        })
    }
}
