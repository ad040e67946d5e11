//! Distance from the set point at which a move ends.
//!
//! A spool that has moved through its hysteresis and is held by friction needs the current of the rising branch to move
//! again. The hitch may then stand still a tenth of a degree before the cut position, with its coil on. Therefore the
//! stop band widens when the final approach takes long.

use hitch_quantities::calibration::design_parameters::PositionParameters;
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{Micrometre, Millisecond};

/// Duration of the final approach from which the stop band widens, in thousandths of the time constant of its end, the
/// inverse of `position.approach_gain`.
const DELAY: i32 = 6_600;
/// Speed at which the stop band grows, in thousandths of the creep speed: slower than the hitch goes.
const GROWTH: i32 = 540;
/// Largest growth of the stop band, in thousandths of it.
const EXTENSION: i32 = 765;

/// The stop band after this duration of the final approach.
#[must_use]
pub fn after(approach_time: Millisecond, parameters: &PositionParameters) -> Micrometre {
    let since = (approach_time - delay(parameters)).max(Millisecond::ZERO);
    // A speed in um/s is the distance of a millisecond in nm.
    let growth_nm = mul_div(parameters.creep_speed.0, GROWTH, Divisor::THOUSAND);
    let grown = Micrometre(mul_div(since.0, growth_nm, Divisor::THOUSAND));
    parameters.stop_band + grown.min(largest_extension(parameters))
}

/// Duration of the final approach from which the stop band widens.
#[must_use]
pub fn delay(parameters: &PositionParameters) -> Millisecond {
    Millisecond(Divisor::at_least_one(parameters.approach_gain.0).divide(DELAY))
}

/// Largest growth of the stop band.
#[must_use]
pub fn largest_extension(parameters: &PositionParameters) -> Micrometre {
    parameters.stop_band.scaled(EXTENSION, Divisor::THOUSAND)
}
