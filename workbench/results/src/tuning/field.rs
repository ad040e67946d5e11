//! Tunes a function in the field: its scenario of the field loop, and the requirements of that scenario.

use std::ops::ControlFlow;

use hitch_plant::Model;
use hitch_quantities::{Calibration, ValidCalibration};

use super::Change;
use super::figures::{Figures, Judged};
use super::knobs::{changes, without};
use super::search::search;
use crate::closed_loop::ScenarioFigure;
use crate::field_loop::scenario::{FieldScenario, drive};

/// First seed of the soils that the search drives on.
const SEARCHED: u64 = 1;
/// First seed of the soils that judge its result.
const UNSEEN: u64 = 101;

/// Weight of what exceeds a requirement, as a multiple of what is within it.
const EXCESS: f64 = 10.0;

/// The tuned values of the draft loop.
const DRAFT: [&str; 5] = [
    "draft.work_filter",
    "draft.crossover",
    "draft.length",
    "draft.dead_band",
    "draft.step",
];
/// Those of the slip guard.
const SLIP: [&str; 3] = ["slip.filter", "slip.slip_per_degree", "slip.crossover"];
/// Those of ride damping.
const RIDE: [&str; 6] = [
    "ride.gain",
    "ride.low_corner",
    "ride.lead",
    "ride.forcing",
    "ride.dead_band",
    "ride.centring_time",
];

/// A scenario on a model.
#[derive(Debug)]
pub struct FieldTrial<'a> {
    model: &'a Model,
    scenario: FieldScenario,
    knobs: &'static [&'static str],
}

impl<'a> FieldTrial<'a> {
    /// Prepares a scenario; `None` if it has no requirements that could be tuned for.
    #[must_use]
    pub fn new(model: &'a Model, scenario: FieldScenario) -> Option<Self> {
        let knobs: &[&str] = match scenario {
            FieldScenario::Draft | FieldScenario::Mix | FieldScenario::Depth => &DRAFT,
            FieldScenario::Slip => &SLIP,
            FieldScenario::Transport => &RIDE,
            FieldScenario::Headland => return None,
        };
        Some(Self {
            model,
            scenario,
            knobs,
        })
    }

    fn driven(&self, calibration: &ValidCalibration, seed: u64) -> Result<Judged, String> {
        let named = drive(self.scenario, self.model, calibration, seed)?.figures;
        Ok(Judged {
            calibration: calibration.clone(),
            figures: Figures {
                cost: cost(&named),
                ..Figures::default()
            },
            named,
        })
    }

    /// Drives the scenario on soils that the search has not seen.
    ///
    /// # Errors
    /// If the model cannot drive it.
    pub fn judge_unseen(&self, calibration: &ValidCalibration) -> Result<Judged, String> {
        self.driven(calibration, UNSEEN)
    }

    /// Searches from `base` with at most `trials` candidates; values named in `fixed` are not changed. `tell` as in [`super::Trial::search`].
    #[must_use]
    pub fn search(
        &self,
        base: &Calibration,
        fixed: &[String],
        trials: usize,
        tell: impl Fn(usize, f64) -> ControlFlow<()> + Sync,
    ) -> Option<Judged> {
        let knobs = without(self.knobs, fixed);
        search(base, &knobs, None, trials, tell, |candidate| {
            self.driven(candidate, SEARCHED).ok()
        })
    }

    /// The values that are tuned, before and after.
    #[must_use]
    pub fn changes(&self, before: &Calibration, after: &Calibration) -> Vec<Change> {
        changes(self.knobs, before, after)
    }
}

/// Mean over the figures with a requirement of their ratio to it, what exceeds the requirement tenfold. Of a requirement of zero, one unit is
/// the ratio one.
fn cost(figures: &[ScenarioFigure]) -> f64 {
    let ratios: Vec<f64> = figures
        .iter()
        .filter_map(|figure| {
            let required = figure.required?;
            let ratio = if required > 0.0 {
                figure.value / required
            } else {
                1.0 + figure.value
            };
            Some(ratio + EXCESS * (ratio - 1.0).max(0.0))
        })
        .collect();
    ratios.iter().sum::<f64>() / ratios.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure(value: f64, required: Option<f64>) -> ScenarioFigure {
        ScenarioFigure {
            name: "slip".to_owned(),
            value,
            unit: "%",
            required,
        }
    }

    #[test]
    fn what_exceeds_a_requirement_costs_more_than_what_is_within_it() {
        let at = |value| cost(&[figure(value, Some(25.0)), figure(99.0, None)]);
        assert!((at(25.0) - 1.0).abs() < 1e-12);
        assert!(at(20.0) < at(25.0));
        assert!(at(26.0) - at(25.0) > 10.0 * (at(25.0) - at(24.0)));
        assert!(cost(&[figure(0.0, Some(0.0))]) < cost(&[figure(0.1, Some(0.0))]));
    }

    #[test]
    fn a_scenario_without_requirements_is_not_tuned() {
        let model = hitch_model_file::dynamic();
        assert!(FieldTrial::new(&model, FieldScenario::Headland).is_none());
        let trial = FieldTrial::new(&model, FieldScenario::Slip).expect("it has requirements");
        let base = Calibration::nominal();
        assert_eq!(
            trial.changes(&base, &base).len(),
            SLIP.len(),
            "every value exists"
        );
    }
}
