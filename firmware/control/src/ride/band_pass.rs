//! Band-pass of the cylinder's pressure, with a lead.
//!
//! ```text
//! p -> p - low-pass(low corner) -> low-pass(high corner) = b -> b + lead db/dt
//! ```
//!
//! The derivative is that of the second low-pass itself, `db/dt = 2 pi f (x - b)`: no difference of samples is taken.

use hitch_quantities::calibration::field_parameters::RideParameters;
use hitch_quantities::fixed::{Divisor, mul_div, mul_shift_16};
use hitch_quantities::units::MilliBar;

use crate::reference::low_pass::{LowPass, RADIAN};

/// The filter.
#[derive(Clone, Copy, Debug, Default)]
pub struct BandPass {
    mean: LowPass,
    band: LowPass,
}

impl BandPass {
    /// One step: the band-passed pressure with its lead.
    pub fn step(&mut self, pressure: MilliBar, parameters: &RideParameters) -> MilliBar {
        let mean = self.mean.step(pressure.0, parameters.low_corner);
        let swing = pressure.0.saturating_sub(mean);
        let band = self.band.step(swing, parameters.high_corner);
        let share = mul_shift_16(parameters.high_corner.0, RADIAN);
        let lead = share.saturating_mul(parameters.lead.0);
        let ahead = mul_div(
            swing.saturating_sub(band),
            lead,
            Divisor::at_least_one(1 << 16),
        );
        MilliBar(band.saturating_add(ahead))
    }

    /// Forgets all samples.
    pub fn reset(&mut self) {
        *self = Self::default();
    }
}
