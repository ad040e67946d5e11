//! `hitch tune` with a scenario of the field.

use hitch_closed_loop::driven::MachineError;
use hitch_closed_loop::with_dynamics;

use super::tune_result::{Found, Search, Tuned};
use hitch_output::error::Error;
use hitch_output::progress::Progress;
use hitch_results::field_loop::scenario::FieldScenario;
use hitch_results::report::tuning_page;
use hitch_results::tuning::FieldTrial;

/// Tunes a function for its scenario. Figures and costs are those on soils that the search has not seen.
///
/// # Errors
/// If the scenario has no requirements, or the model cannot drive it.
pub fn tuned(search: &Search<'_>, scenario: FieldScenario) -> Result<Found, Error> {
    let model = with_dynamics(search.model).map_err(MachineError::from)?;
    let trial = FieldTrial::new(&model, scenario).ok_or_else(|| {
        Error::Usage(
            "the scenario has no requirements to tune for; take draft, mix, slip, depth or transport"
                .to_owned(),
        )
    })?;
    let progress = Progress::start("driving in the field");
    let before = trial.judge_unseen(search.base).map_err(Error::Usage)?;
    drop(progress);
    let best = search
        .told(|tell| trial.search(search.base, search.fixed, search.trials, tell))
        .ok_or_else(Search::nothing)?;
    let after = trial
        .judge_unseen(&best.calibration)
        .map_err(Error::Usage)?;
    let tuned = Tuned {
        changes: trial.changes(search.base, &best.calibration),
        before: before.figures,
        after: after.figures,
        figures: before.compared(&after),
    };
    let page = tuning_page::page(&tuning_page::Shown {
        model: &model,
        changes: &tuned.changes,
        figures: &tuned.figures,
        moves: None,
        presses: None,
    });
    Ok(Found {
        calibration: best.calibration,
        tuned,
        page,
    })
}
