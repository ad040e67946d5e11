//! The pressure drop over the lowering valve: measured if there is a sensor, else learnt from how fast
//! the hitch sinks.
//!
//! Lowering is not compensated, so speed goes with the root of the drop: `v / v_model = sqrt(dp / dp_est)`.
//! With `r = (v - v_model) / v_model` small, `dp / dp_est - 1 = 2 r`; the estimate follows that in
//! [`HydraulicParameters::drop_learning`]. The load stays on the hitch between moves, so the estimate does.

use super::design_parameters::HydraulicParameters;
use super::fixed::{Divisor, mul_div};
use super::motion::Motion;
use super::units::{MicrometrePerSecond, MilliBar};

/// Sinking slower than this (of the map's 280 mm/s) says more about the threshold than about the load.
const TELLING_SPEED: MicrometrePerSecond = MicrometrePerSecond(25_000);

/// Pressure drop over the lowering valve.
#[derive(Clone, Copy, Debug)]
pub struct LoadEstimate {
    /// In microbars, so that slow learning isn't rounded away.
    microbar: i32,
    /// The sensor's last sample.
    sensor: Option<MilliBar>,
}

impl LoadEstimate {
    /// Starts at the calibration's assumption.
    #[must_use]
    pub fn new(hydraulics: &HydraulicParameters) -> Self {
        Self {
            microbar: hydraulics.assumed_drop.0.saturating_mul(1000),
            sensor: None,
        }
    }

    /// One step: follows the sensor if there is one, else learns from `motion` while it is lowering.
    pub fn update(
        &mut self,
        sensor: Option<MilliBar>,
        lowering: bool,
        motion: &Motion,
        hydraulics: &HydraulicParameters,
    ) {
        match (sensor, self.sensor) {
            (Some(pressure), None) => self.microbar = pressure.0.saturating_mul(1000),
            (Some(pressure), Some(_)) => self.follow(pressure, hydraulics),
            (None, _) if lowering => self.learn(motion, hydraulics),
            (None, _) => {}
        }
        self.sensor = sensor;
        let low = hydraulics.smallest_drop.0.saturating_mul(1000);
        let high = hydraulics.largest_drop.0.saturating_mul(1000);
        self.microbar = self.microbar.max(low).min(high);
    }

    /// The drop at this moment, for telling what flows: the load's inertia can treble the pressure within the
    /// time in which [`Self::drop`] follows.
    #[must_use]
    pub fn present_drop(&self, hydraulics: &HydraulicParameters) -> MilliBar {
        let drop = self.sensor.unwrap_or_else(|| self.drop());
        drop.limited(hydraulics.smallest_drop, hydraulics.largest_drop)
    }

    /// The drop that the lowering map should use.
    #[must_use]
    pub fn drop(&self) -> MilliBar {
        MilliBar(Divisor::THOUSAND.divide(self.microbar))
    }

    /// Low-passes the sensor.
    fn follow(&mut self, pressure: MilliBar, hydraulics: &HydraulicParameters) {
        let error = pressure
            .0
            .saturating_mul(1000)
            .saturating_sub(self.microbar);
        let step = hydraulics.pressure_filter.divisor().divide(error);
        self.microbar = self.microbar.saturating_add(step);
    }

    fn learn(&mut self, motion: &Motion, hydraulics: &HydraulicParameters) {
        let model = -motion.model_speed();
        if model < TELLING_SPEED {
            return;
        }
        let excess = (-motion.bias()).limited(-model, model);
        let twice = mul_div(
            self.microbar,
            excess.0.saturating_mul(2),
            Divisor::at_least_one(model.0),
        );
        let step = hydraulics.drop_learning.divisor().divide(twice);
        self.microbar = self.microbar.saturating_add(step);
    }
}
