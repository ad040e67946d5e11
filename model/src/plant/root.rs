//! A bracketed root of a rising function, for the algebraic loops of the steady plant.

/// Root of a function that rises from at most zero at `low` to at least zero at `high`, to within `tolerance`.
///
/// Illinois variant of the false position: no derivative, never leaves the bracket. Inside the plant's inner loop a
/// general solver crate costs more than the physics, hence these lines.
#[must_use]
pub fn rising(function: impl Fn(f64) -> f64, mut low: f64, mut high: f64, tolerance: f64) -> f64 {
    let (mut at_low, mut at_high) = (function(low), function(high));
    if at_low >= 0.0 {
        return low;
    }
    if at_high <= 0.0 {
        return high;
    }
    let mut last_side = 0_i8;
    for _ in 0..100 {
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        let at_middle = function(middle);
        if at_middle == 0.0 {
            return middle;
        }
        let (moved, side) = if at_middle > 0.0 {
            let moved = high - middle;
            (high, at_high) = (middle, at_middle);
            if last_side == 1 {
                at_low *= 0.5;
            }
            (moved, 1)
        } else {
            let moved = middle - low;
            (low, at_low) = (middle, at_middle);
            if last_side == -1 {
                at_high *= 0.5;
            }
            (moved, -1)
        };
        last_side = side;
        if moved <= tolerance || high - low <= tolerance {
            return middle;
        }
    }
    0.5 * (low + high)
}
