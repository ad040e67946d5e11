//! What is late by itself and what is only stamped late.
//!
//! A lag and the clocks of the channels that it delays share what is late between them. Its kind (how much of it is
//! dead time, how much a second stage) tells them apart, but between two samples a moved clock rounds the corners as a
//! second stage does: there are valleys with clocks that are off, and no slope leads from one to the next.

use super::clocks::{Clocks, OFFSET_PRIOR_S};
use super::estimate::Estimate;
use super::experiment::Experiment;
use super::fit::{Fit, refine};
use crate::effects::{AddedEffect, Effect};
use crate::model::Model;

/// Clocks that are off by more than this, s, may stand in for what is missing.
const OFF_S: f64 = 2.0 * OFFSET_PRIOR_S;

/// A fit's clocks are off by so much, s, if the last effect's lag may be in another valley.
const ASTRAY_S: f64 = 0.5 * OFFSET_PRIOR_S;

/// How late the clocks of an effect's channels are on the whole, s; `None` if it is no lag.
fn late_s(clocks: &Clocks, effect: &dyn Effect) -> Option<f64> {
    if effect.parameters()[0].unit != "s" {
        return None;
    }
    let channels = effect.channels().iter();
    let mut late_s: Vec<f64> = channels
        .map(|channel| clocks.offsets_s[channel.index()])
        .collect();
    late_s.sort_by(f64::total_cmp);
    late_s.get(late_s.len() / 2).copied()
}

/// A lag in place of the clocks that stand in for it, in the typical shape: what makes a spool late makes all its
/// channels late, and once their clocks have run off with that no slope leads back.
pub(super) fn in_place_of_clocks(
    estimate: &Estimate,
    effect: &'static dyn Effect,
) -> Option<Estimate> {
    let late_s = late_s(&estimate.clocks, effect).filter(|&late_s| late_s > OFF_S)?;
    let mut added = AddedEffect::typical(effect);
    added.values[0] = late_s;
    let mut start = estimate.clone();
    start.effects.push(added);
    start.clocks = Clocks::default();
    Some(start)
}

/// The better of a fit and of the one that a start with the same lateness, but all of it the last effect's, leads to.
pub(super) fn on_time(experiment: &Experiment, model: &Model, fit: Fit) -> Fit {
    let mut start = fit.estimate.clone();
    let Some(added) = start.effects.last_mut() else {
        return fit;
    };
    let late_s = late_s(&fit.estimate.clocks, added.effect);
    let Some(late_s) = late_s.filter(|late_s| late_s.abs() > ASTRAY_S) else {
        return fit;
    };
    added.values[0] = (added.values[0] + late_s).max(added.effect.parameters()[0].low);
    start.clocks = Clocks::default();
    start.clocks_held = true;
    let mut settled = refine(experiment, model, start).estimate;
    settled.clocks_held = false;
    let other = refine(experiment, model, settled);
    if other.cost < fit.cost { other } else { fit }
}
