//! Rest position: the position estimate, averaged for long enough to distinguish a leak from noise and from an
//! oscillating load.

use hitch_quantities::calibration::design_parameters::HoldParameters;
use hitch_quantities::fixed::{Divisor, behind};
use hitch_quantities::units::Micrometre;

/// Averaged position; it follows without delay at the start and while the hitch does not rest.
#[derive(Clone, Copy, Debug, Default)]
pub struct RestPosition {
    started: bool,
    nanometre: i32,
}

impl RestPosition {
    /// One step. `rests`: the hitch rests, and its position is known.
    pub fn update(&mut self, position: Micrometre, rests: bool, parameters: &HoldParameters) {
        let time = if rests && self.started {
            parameters.rest_time.divisor()
        } else {
            Divisor::ONE
        };
        self.started = true;
        let position_nm = position.0.saturating_mul(1000);
        self.nanometre = behind(self.nanometre, position_nm, time);
    }

    /// The average.
    #[must_use]
    pub fn position(&self) -> Micrometre {
        Micrometre(Divisor::THOUSAND.divide(self.nanometre))
    }
}
