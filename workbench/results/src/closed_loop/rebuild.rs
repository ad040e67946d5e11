//! Rebuilds the valve map from an identified model, and measures its effect in closed loop.

use hitch_plant::Model;
use hitch_quantities::{Calibration, ValidCalibration};

use crate::closed_loop::{self, LoopRun, MoveResult, Scenario, Summary};
use crate::explanation::Found;
use hitch_closed_loop::calibrate::calibrate;
use hitch_closed_loop::driven::MachineError;
use hitch_closed_loop::with_dynamics;
use hitch_output::error::Error;
use hitch_output::text::{Table, known};

/// The same moves of the same rig under the valve map of the initial model and under the rebuilt one.
#[derive(Debug, Clone)]
pub struct Rebuild {
    /// The rig: the identified model with dynamics.
    pub rig: Model,
    /// The calibration of the initial model.
    pub nominal: ValidCalibration,
    /// The calibration with the valves of the identified model.
    pub rebuilt: ValidCalibration,
    /// The moves under the calibration of the initial model.
    pub before: LoopRun,
    /// The moves under the rebuilt calibration.
    pub after: LoopRun,
}

/// Summary of the moves of one kind.
#[derive(Debug, Clone, Copy)]
struct Way {
    name: &'static str,
    before: Summary,
    after: Summary,
}

impl Rebuild {
    /// Rebuilds the map from the identified effects, and drives the moves of `scenario` with both maps.
    ///
    /// # Errors
    /// If the firmware rejects the map of one of the models, or the identified one has no linkage.
    pub fn new(found: &Found, scenario: Scenario) -> Result<Self, Error> {
        let identified = found.rebuilt("identified".to_owned());
        let rig = with_dynamics(&identified).map_err(MachineError::from)?;
        let failed = |error: &dyn std::fmt::Display| {
            Error::Failed(format!("the valve map cannot be rebuilt: {error}"))
        };
        let calibration = |model: &Model| {
            calibrate(model, &Calibration::nominal()).map_err(|error| failed(&error))
        };
        let (nominal, rebuilt) = (calibration(&found.model)?, calibration(&identified)?);
        let moves = scenario.moves(&rig, None);
        let drive = |calibration: &ValidCalibration| {
            closed_loop::run(&rig, calibration, &moves)
                .ok_or_else(|| failed(&"the scenario has no moves"))
        };
        let (before, after) = (drive(&nominal)?, drive(&rebuilt)?);
        Ok(Self {
            rig,
            nominal,
            rebuilt,
            before,
            after,
        })
    }

    /// The effect of the rebuilt map, as text.
    pub fn text(&self) -> String {
        let thresholds = [&self.nominal, &self.rebuilt]
            .map(|calibration| f64::from(calibration.lower.threshold().0) * 1e-3);
        let mut table = Table::new(["", "nominal map", "rebuilt map"]);
        for way in self.ways() {
            let mut row = |name: &str, figure: fn(&Summary) -> f64, digits: usize| {
                let numbers =
                    [figure(&way.before), figure(&way.after)].map(|number| known(number, digits));
                table.row([format!("{}: {name}", way.name)].into_iter().chain(numbers));
            };
            row("time ratio, median", |summary| summary.ratio_median, 2);
            row("time ratio, 95 % quantile", |summary| summary.ratio_p95, 2);
            row(
                "tracking error, median, deg",
                |summary| summary.tracking_error_median_deg,
                2,
            );
            row(
                "largest overshoot, deg",
                |summary| summary.overshoot_max_deg,
                2,
            );
            row(
                "largest final error, deg",
                |summary| summary.final_error_max_deg,
                2,
            );
        }
        format!(
            "Lowering threshold in the valve map: {:.3} A -> {:.3} A\n\nClosed loop, {} moves of this rig\n{table}",
            thresholds[0],
            thresholds[1],
            self.before.results.len()
        )
    }

    fn ways(&self) -> Vec<Way> {
        let lifting = |result: &MoveResult| result.to_deg > result.from_deg;
        let summary = |run: &LoopRun, lifts: bool| {
            let moves: Vec<MoveResult> = run
                .results
                .iter()
                .filter(|result| lifting(result) == lifts)
                .copied()
                .collect();
            Summary::of(&moves)
        };
        let way = |(name, lifts)| {
            Some(Way {
                name,
                before: summary(&self.before, lifts)?,
                after: summary(&self.after, lifts)?,
            })
        };
        [("lifting", true), ("lowering", false)]
            .into_iter()
            .filter_map(way)
            .collect()
    }

    /// Index of the move that the rebuilt map shortens most.
    pub fn most_shortened(&self) -> Option<usize> {
        let gain_s = |index: &usize| {
            self.before.results[*index].took_s() - self.after.results[*index].took_s()
        };
        (0..self.before.results.len().min(self.after.results.len()))
            // A move that arrives with neither map has no time to compare.
            .filter(|index| !gain_s(index).is_nan())
            .max_by(|a, b| gain_s(a).total_cmp(&gain_s(b)))
    }
}
