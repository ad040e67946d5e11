//! Resolution limits: sizes that a log cannot distinguish from zero, regardless of the number of samples.

use hitch_plant::ParameterKind;

use crate::data::experiment::Experiment;
use crate::estimate::Estimate;

/// Smallest accepted width of a current hysteresis or dead band, in sigmas of the logged currents. A narrower one
/// suppresses the valve motion that the remaining current noise would cause, and improves the fit without being there.
const SMALLEST_WIDTH: f64 = 1.5;

/// Whether all changes of an estimate relative to the model exceed the uncertainty of the logged currents and of the
/// instants of their jumps.
pub(crate) fn is_resolved(experiment: &Experiment, estimate: &Estimate) -> bool {
    estimate.changed().all(|index| {
        let added = &estimate.effects[index];
        let size = &added.effect.parameters()[0];
        let off = (added.values[0] - estimate.off(index)).abs();
        let noise = experiment.current_noise;
        let is_width = size.kind == ParameterKind::Current && size.low == size.null;
        let is_lag = size.kind == ParameterKind::Time && size.null == 0.0;
        (!is_width || off > SMALLEST_WIDTH * noise.lift_a.max(noise.lower_a))
            && (!is_lag || off > experiment.jumps_within_s)
    })
}
