//! Quantities that vary over the stroke, with a linear and a quadratic term.

use hitch_plant::Parameter;

/// A parameter for the relative variation of a quantity over the stroke.
pub(crate) const fn shape(name: &'static str, meaning: &'static str, widest: f64) -> Parameter {
    Parameter {
        meaning,
        typical: 0.1,
        low: -widest,
        high: widest,
        ..Parameter::ratio(name)
    }
}

/// Ratio of a quantity at a piston travel to its mean over the stroke: `1 + slope z + bow (3 z^2 - 1) / 2` with
/// `z = 2 x / stroke - 1`, Legendre polynomials, whose mean over the stroke is zero.
pub(crate) fn over_mean([slope, bow]: [f64; 2], piston_m: f64, stroke_m: f64) -> f64 {
    let z = 2.0 * piston_m / stroke_m - 1.0;
    1.0 + slope * z + 0.5 * bow * (3.0 * z * z - 1.0)
}
