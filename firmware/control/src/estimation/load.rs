//! The pressure drop over the lowering valve: measured if there is a sensor, else learnt from how fast
//! the hitch sinks.
//!
//! Lowering is not compensated, so speed goes with the root of the drop: `v / v_model = sqrt(dp / dp_est)`.
//! With `r = (v - v_model) / v_model` small, `dp / dp_est - 1 = 2 r`; the estimate follows that in
//! [`HydraulicParameters::drop_learning`]. The load stays on the hitch between moves, so the estimate does.

use hitch_quantities::calibration::design_parameters::HydraulicParameters;
use hitch_quantities::fixed::{Divisor, mul_div, mul_shift_16};
use hitch_quantities::units::{MicrometrePerSecond, MilliBar};

use super::motion_observer::MotionObserver;
use crate::valve::phase::{Direction, Phase};

/// Sinking slower than this (of the map's 280 mm/s) says more about the threshold than about the load.
const TELLING_SPEED: MicrometrePerSecond = MicrometrePerSecond(25_000);

/// Largest factor that sinking may teach, and its inverse the smallest.
const MOST_FACTOR: i32 = 10;

/// The learnt factor's one.
const ONE: i32 = 1 << 16;

/// Pressure drop over the lowering valve.
#[derive(Clone, Copy, Debug)]
pub struct LoadEstimate {
    /// What a sensor says at rest, or the calibration assumes; in microbars, so that slow changes aren't rounded away.
    resting_microbar: i32,
    /// What sinking has taught to multiply that by, in units of 2^-16: the load, and how thin the oil is.
    factor: i32,
    /// The product.
    microbar: i32,
    /// Whether the sensor has been seen.
    has_sensor: bool,
}

impl LoadEstimate {
    /// Starts at the calibration's assumption.
    #[must_use]
    pub fn new(hydraulics: &HydraulicParameters) -> Self {
        let assumed = hydraulics.assumed_drop.0.saturating_mul(1000);
        Self {
            resting_microbar: assumed,
            factor: ONE,
            microbar: assumed,
            has_sensor: false,
        }
    }

    /// One step: at rest follows the sensor if there is one, while lowering learns from `motion`.
    pub fn update(
        &mut self,
        sensor: Option<MilliBar>,
        phase: Phase,
        motion: &MotionObserver,
        hydraulics: &HydraulicParameters,
    ) {
        match (phase, sensor) {
            (
                Phase::Moving {
                    direction: Direction::Lower,
                    ..
                },
                _,
            ) => self.learn(motion, hydraulics),
            (Phase::Holding, Some(pressure)) => self.follow(pressure, hydraulics),
            _ => return,
        }
        let low = hydraulics.smallest_drop.0.saturating_mul(1000);
        let high = hydraulics.largest_drop.0.saturating_mul(1000);
        self.microbar = mul_shift_16(self.resting_microbar, self.factor)
            .max(low)
            .min(high);
    }

    /// The drop that the lowering map should use.
    #[must_use]
    pub fn drop(&self) -> MilliBar {
        MilliBar(Divisor::THOUSAND.divide(self.microbar))
    }

    /// Low-passes the sensor.
    fn follow(&mut self, pressure: MilliBar, hydraulics: &HydraulicParameters) {
        let pressure = pressure.0.saturating_mul(1000);
        if !self.has_sensor {
            self.has_sensor = true;
            self.resting_microbar = pressure;
        }
        let error = pressure.saturating_sub(self.resting_microbar);
        let step = hydraulics.pressure_filter.divisor().divide(error);
        self.resting_microbar = self.resting_microbar.saturating_add(step);
    }

    fn learn(&mut self, motion: &MotionObserver, hydraulics: &HydraulicParameters) {
        let model = -motion.model_speed();
        if model < TELLING_SPEED {
            return;
        }
        let excess = (-motion.bias()).limited(-model, model);
        // Speeds in steps of 64 um/s: the ECU divides 32 bits and not 64.
        let twice = mul_div(
            self.factor,
            excess.0 / 32,
            Divisor::at_least_one(model.0 / 64),
        );
        let step = hydraulics.drop_learning.divisor().divide(twice);
        self.factor = self
            .factor
            .saturating_add(step)
            .clamp(ONE / MOST_FACTOR, ONE * MOST_FACTOR);
    }
}
