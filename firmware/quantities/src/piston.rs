//! Flow and speed of the piston.

use crate::fixed::Divisor;
use crate::units::{MicroLitrePerSecond, MicrometrePerSecond, SquareMillimetre};

/// Flow that moves the piston at `speed`.
#[must_use]
pub fn flow(speed: MicrometrePerSecond, area: SquareMillimetre) -> MicroLitrePerSecond {
    // um/s * mm2 = 1e-3 mm3/s
    MicroLitrePerSecond(speed.0).scaled(area.0, Divisor::THOUSAND)
}

/// Piston speed that a flow gives.
#[must_use]
pub fn piston_speed(flow: MicroLitrePerSecond, area: SquareMillimetre) -> MicrometrePerSecond {
    // One of the valves always is shut.
    if flow == MicroLitrePerSecond::ZERO {
        return MicrometrePerSecond::ZERO;
    }
    MicrometrePerSecond(flow.0).scaled(1000, Divisor::at_least_one(area.0))
}
