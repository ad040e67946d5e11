//! The effects that a search may add.

use hitch_plant::{Effect, Model};

use crate::data::problem::Problem;
use crate::estimate::Estimate;

/// Callback with a description of the current task, for progress displays.
pub type Progress<'a> = &'a (dyn Fn(&str) + Sync);

/// Effects that the plant can have and that the estimate does not contain.
pub(crate) fn absent(model: &Model, estimate: &Estimate) -> Vec<&'static dyn Effect> {
    possible(model)
        .filter(|effect| !has(estimate, *effect))
        .collect()
}

/// Those of them that act on a measured channel: an angle sensor that was not logged explains nothing.
pub(crate) fn showing(problem: Problem<'_>, estimate: &Estimate) -> Vec<&'static dyn Effect> {
    let Problem {
        experiment, model, ..
    } = problem;
    let mut absent = absent(model, estimate);
    absent.retain(|effect| {
        let mut channels = effect.channels().iter();
        channels.any(|channel| experiment.measures(*channel))
    });
    absent
}

/// Effects that the plant can have.
pub(crate) fn possible(model: &Model) -> impl Iterator<Item = &'static dyn Effect> {
    let dynamics = model.constants().dynamics;
    let effects = hitch_effects::available(model).into_iter();
    effects.filter(move |effect| effect.needs().is_none_or(|needed| needed == dynamics))
}

fn has(estimate: &Estimate, effect: &dyn Effect) -> bool {
    estimate
        .effects
        .iter()
        .any(|added| added.effect.id() == effect.id())
}
