//! What is late by itself and what is only stamped late.
//!
//! A lag and the clocks of the channels that it delays share what is late between them. Its kind (how much of it is
//! dead time, how much a second stage) tells them apart, but between two samples a moved clock rounds the corners as a
//! second stage does: there are valleys with clocks that are off, and no slope leads from one to the next.

use hitch_plant::{Effect, Model, ParameterKind};

use crate::data::clocks::{Clocks, OFFSET_PRIOR_S};
use crate::data::experiment::Experiment;
use crate::estimate::Estimate;
use crate::estimation::fit::{Fit, refine};

/// A fit's clocks are off by so much, s, if a lag may be in another valley.
const ASTRAY_S: f64 = 0.5 * OFFSET_PRIOR_S;

/// The better of a fit and of the one that a start with the same lateness, but all of it a lag's, leads to.
pub(crate) fn on_time(experiment: &Experiment, model: &Model, fit: Fit) -> Fit {
    let Some(start) = given_back(&fit.estimate) else {
        return fit;
    };
    let other = refine(experiment, model, start);
    if other.cost < fit.cost { other } else { fit }
}

/// Whether an effect delays what a channel shows: its size is a time.
pub(crate) fn is_delay(effect: &dyn Effect) -> bool {
    effect.parameters()[0].kind == ParameterKind::Time
}

/// An estimate whose lag has what the clocks of its channels took; `None` without a lag or where the clocks are in step.
fn given_back(estimate: &Estimate) -> Option<Estimate> {
    let is_lag =
        |&index: &usize| is_delay(estimate.effects[index].effect) && !estimate.is_unchanged(index);
    let index = (0..estimate.effects.len()).find(is_lag)?;
    let effect = estimate.effects[index].effect;
    let channels = effect.channels().iter();
    let mut late_s: Vec<f64> = channels
        .map(|channel| estimate.clocks.offsets_s[channel.index()])
        .collect();
    late_s.sort_by(f64::total_cmp);
    let late_s = late_s.get(late_s.len() / 2).copied()?;
    (late_s.abs() > ASTRAY_S).then(|| {
        let mut start = estimate.clone();
        let added = &mut start.effects[index];
        added.values[0] = (added.values[0] + late_s).max(effect.parameters()[0].low);
        start.clocks = Clocks::default();
        start
    })
}
