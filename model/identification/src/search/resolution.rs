//! Sizes that a log cannot tell from nothing, however many samples it has.

use hitch_plant::ParameterKind;

use crate::data::experiment::Experiment;
use crate::estimate::Estimate;

/// Width of a current path that is believed, in sigmas of the logged currents: as wide as what cleaning leaves of their
/// noise it holds the valves still that this would shake, and fits better though nothing is there.
const HELD_STILL: f64 = 1.5;

/// Whether all that an estimate has beyond the model is larger than what the log leaves unknown of its currents and of
/// when they jumped.
pub(crate) fn is_resolved(experiment: &Experiment, estimate: &Estimate) -> bool {
    let effects = (0..estimate.effects.len()).filter(|&index| !estimate.is_unchanged(index));
    effects.into_iter().all(|index| {
        let added = &estimate.effects[index];
        let size = &added.effect.parameters()[0];
        let off = (added.values[0] - estimate.off(index)).abs();
        let noise = experiment.current_noise;
        let is_width = size.kind == ParameterKind::Current && size.low == size.null;
        let is_lag = size.kind == ParameterKind::Time && size.null == 0.0;
        (!is_width || off > HELD_STILL * noise.lift_a.max(noise.lower_a))
            && (!is_lag || off > experiment.jumps_within_s)
    })
}
