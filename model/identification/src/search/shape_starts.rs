//! Sizes and shapes at which effects are simulated for screening.

use hitch_plant::{AddedEffect, Channel, Effect, Parameter, SizeResponse};

use crate::data::experiment::Experiment;
use crate::search::size_grid::{Grid, LOCATED, LOCATED_WITHOUT_RINGING, RINGING, SWITCHING};

/// An effect at a multiple of its size.
pub(crate) fn scaled(added: &AddedEffect, share: f64) -> AddedEffect {
    let null = added.effect.parameters()[0].null;
    let mut scaled = added.clone();
    scaled.values[0] = null + share * (scaled.values[0] - null);
    scaled
}

/// The scan grid of an effect whose cost has many local minima: due to the phase of a ringing pressure, or to switching
/// or bouncing.
pub(crate) fn scan_grid(experiment: &Experiment, effect: &dyn Effect) -> Option<&'static Grid> {
    let pressure_alone = effect.channels() == [Channel::CylinderPressure];
    match effect.size_response() {
        SizeResponse::Switching => Some(&SWITCHING),
        SizeResponse::Located if experiment.ringing => Some(&LOCATED),
        SizeResponse::Located => Some(&LOCATED_WITHOUT_RINGING),
        SizeResponse::Smooth if experiment.ringing && pressure_alone => Some(&RINGING),
        SizeResponse::Smooth | SizeResponse::Stepped => None,
    }
}

/// An effect at its typical size with each signed shape parameter at both ends of its range. A load arm that grows over
/// the stroke and one that is constant have nothing in common, so the secant of one does not reveal the other.
pub(crate) fn with_opposite_shapes(effect: &'static dyn Effect) -> Vec<AddedEffect> {
    let typical = AddedEffect::typical(effect);
    with_shapes(&typical, |shape| shape.low < 0.0 && shape.high > 0.0)
}

/// An effect with each shape parameter towards either end of its range in turn; none without a shape.
pub(crate) fn with_extreme_shapes(at: &AddedEffect) -> Vec<AddedEffect> {
    with_shapes(at, |_| true)
}

/// [`with_extreme_shapes`] for the parameters selected by `chosen`.
fn with_shapes(at: &AddedEffect, chosen: impl Fn(&Parameter) -> bool) -> Vec<AddedEffect> {
    let parameters = at.effect.parameters().iter().enumerate().skip(1);
    parameters
        .filter(|(_, range)| chosen(range))
        .flat_map(|(index, range)| {
            let ends = [range.low, range.high].into_iter();
            ends.filter(|end| end.is_finite()).map(move |end| {
                let mut added = at.clone();
                added.values[index] = extreme(range, end);
                added
            })
        })
        .collect()
}

/// A start value near the end of the range. For a range over several orders of magnitude it is the geometric mean of
/// the typical value and the end: near the end itself, where for instance the ground is almost rigid, the gradient
/// vanishes.
fn extreme(range: &Parameter, end: f64) -> f64 {
    if range.is_by_magnitude() {
        (range.typical * end).sqrt()
    } else {
        end
    }
}
