//! The effects that a search may add.

use hitch_plant::{Effect, Model};

use crate::data::experiment::Experiment;
use crate::estimate::Estimate;

/// Report of what is being done, for progress displays.
pub type Progress<'a> = &'a (dyn Fn(&str) + Sync);

/// Effects that the plant can have and the estimate has not.
pub(crate) fn absent(model: &Model, estimate: &Estimate) -> Vec<&'static dyn Effect> {
    possible(model)
        .filter(|effect| !has(estimate, *effect))
        .collect()
}

/// Those of them that show in a channel that the experiment has. An angle sensor that nobody logged is no explanation.
pub(crate) fn showing(
    experiment: &Experiment,
    model: &Model,
    estimate: &Estimate,
) -> Vec<&'static dyn Effect> {
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
