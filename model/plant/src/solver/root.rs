//! Bracketed root finding for increasing functions, for the algebraic loops of the plant.
//!
//! Illinois variant of regula falsi: it needs no derivative and never leaves the bracket. In the plant's inner loop a
//! general solver crate would cost more than the physics.

/// Most evaluations of one search.
const MOST_EVALUATIONS: usize = 100;

/// Root of a function that increases from at most zero at `low` to at least zero at `high`, to within `tolerance`.
#[must_use]
pub fn rising(function: impl Fn(f64) -> f64, low: f64, high: f64, tolerance: f64) -> f64 {
    let at = |argument: f64| (function(argument), argument);
    let (at_low, at_high) = (function(low), function(high));
    if at_low >= 0.0 {
        return low;
    }
    if at_high <= 0.0 {
        return high;
    }
    illinois(at, (low, at_low), (high, at_high), tolerance, 0.0)
}

/// The outcome at the root of a function with a slope of about one or more, within `low` to `high`, to within
/// `tolerance`; the outcome at an end if the function does not change its sign.
///
/// `function` returns its value and an outcome. From a good `guess` three evaluations are sufficient: with such a slope
/// the root is no further away than the function's value.
#[inline(always)]
#[must_use]
pub fn steep<T>(
    function: impl Fn(f64) -> (f64, T),
    guess: f64,
    (low, high): (f64, f64),
    tolerance: f64,
) -> T {
    let (at_guess, outcome) = function(guess);
    if at_guess.abs() <= tolerance {
        return outcome;
    }
    let mut opposite = (guess - at_guess).clamp(low, high);
    let (mut at_opposite, mut outcome) = function(opposite);
    if (at_opposite > 0.0) == (at_guess > 0.0) {
        opposite = if at_guess > 0.0 { low } else { high };
        (at_opposite, outcome) = function(opposite);
    }
    if at_opposite.abs() <= tolerance || (at_opposite > 0.0) == (at_guess > 0.0) {
        return outcome;
    }
    let (guess, opposite) = ((guess, at_guess), (opposite, at_opposite));
    let (below, above) = if at_guess > 0.0 {
        (opposite, guess)
    } else {
        (guess, opposite)
    };
    illinois(function, below, above, tolerance, tolerance)
}

/// The outcome at the root between two points, given with the function's values, the first negative and the second
/// positive: to within `tolerance` of the argument, or `small` in value.
fn illinois<T>(
    function: impl Fn(f64) -> (f64, T),
    (mut low, mut at_low): (f64, f64),
    (mut high, mut at_high): (f64, f64),
    tolerance: f64,
    small: f64,
) -> T {
    let (mut last_side, mut evaluations) = (0_i8, 0);
    loop {
        let middle = (low * at_high - high * at_low) / (at_high - at_low);
        let (at_middle, outcome) = function(middle);
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
        evaluations += 1;
        let found = at_middle.abs() <= small || moved <= tolerance || high - low <= tolerance;
        if found || evaluations == MOST_EVALUATIONS {
            return outcome;
        }
    }
}
