//! Separation of a real lag from a clock offset.
//!
//! The delay of a channel is split between a lag and the channel's clock offset. The form of the lag (its dead time and
//! its second stage) distinguishes them, but between two samples a clock offset rounds corners as a second stage does.
//! The cost therefore has separate local minima with different clock offsets, and no descent path between them.

use hitch_plant::{Effect, ParameterKind};

use crate::data::clocks::{Clocks, OFFSET_PRIOR_S};
use crate::data::problem::Problem;
use crate::estimate::Estimate;
use crate::estimation::fit::{Fit, refine};

/// Clock offset of a fit, s, above which its lag may be in another local minimum.
const AMBIGUOUS_OFFSET_S: f64 = 0.5 * OFFSET_PRIOR_S;

/// The better of a fit and of the fit from a start with the same total delay, all of it assigned to the lag.
pub(crate) fn with_best_delay_split(problem: Problem<'_>, fit: Fit) -> Fit {
    let Some(start) = with_offsets_in_lag(&fit.estimate) else {
        return fit;
    };
    let other = refine(problem, start);
    if other.cost < fit.cost { other } else { fit }
}

/// Whether an effect delays a channel: its size is a time.
pub(crate) fn is_delay(effect: &dyn Effect) -> bool {
    effect.parameters()[0].kind == ParameterKind::Time
}

/// An estimate with the clock offsets of the lag's channels moved into the lag; `None` without a lag or with clocks
/// that are in step.
fn with_offsets_in_lag(estimate: &Estimate) -> Option<Estimate> {
    let is_lag = |&index: &usize| is_delay(estimate.effects[index].effect);
    let index = estimate.changed().find(is_lag)?;
    let effect = estimate.effects[index].effect;
    let channels = effect.channels().iter();
    let mut late_s: Vec<f64> = channels
        .map(|channel| estimate.clocks.offsets_s[channel.index()])
        .collect();
    late_s.sort_by(f64::total_cmp);
    let late_s = late_s.get(late_s.len() / 2).copied()?;
    (late_s.abs() > AMBIGUOUS_OFFSET_S).then(|| {
        let mut start = estimate.clone();
        let added = &mut start.effects[index];
        added.values[0] = (added.values[0] + late_s).max(effect.parameters()[0].low);
        start.clocks = Clocks::default();
        start
    })
}
