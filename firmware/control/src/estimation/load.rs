//! Pressure drop over the lowering valve: measured if there is a sensor, otherwise estimated from the sinking speed.
//!
//! Lowering is not compensated, so the speed is proportional to the square root of the drop:
//! `v / v_model = sqrt(dp / dp_est)`. For a small `r = (v - v_model) / v_model`, `dp / dp_est - 1 = 2 r`. The estimate
//! follows with the time constant [`HydraulicParameters::drop_learning`]. It is kept between moves, because the load
//! stays on the hitch.

use hitch_quantities::calibration::design_parameters::HydraulicParameters;
use hitch_quantities::fixed::{Divisor, behind, mul_div, mul_shift_16};
use hitch_quantities::units::{MicrometrePerSecond, MilliBar};

use super::motion_observer::MotionObserver;
use crate::valve::phase::{Direction, Phase};

/// Smallest sinking speed for the estimate (the map has 280 mm/s): below it the threshold dominates.
const TELLING_SPEED: MicrometrePerSecond = MicrometrePerSecond(25_000);

/// Largest factor of the estimate; its inverse is the smallest.
const MOST_FACTOR: i32 = 10;

/// A factor of one.
const ONE: i32 = 1 << 16;

/// Pressure drop over the lowering valve.
#[derive(Clone, Copy, Debug)]
pub struct LoadEstimate {
    /// Drop at rest by the sensor or the calibration, in microbar, so that slow changes are not rounded away.
    resting_microbar: i32,
    /// Factor from the sinking speed, in units of 2^-16: load and viscosity of the oil.
    factor: i32,
    /// The product.
    microbar: i32,
    /// Whether the sensor has delivered a value.
    has_sensor: bool,
}

impl LoadEstimate {
    /// Starts with the assumption of the calibration.
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

    /// One step: at rest the sensor is followed, if there is one; during lowering the factor is estimated from
    /// `motion`.
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

    /// The drop for the lowering map.
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
        let time = hydraulics.pressure_filter.divisor();
        self.resting_microbar = behind(self.resting_microbar, pressure, time);
    }

    fn learn(&mut self, motion: &MotionObserver, hydraulics: &HydraulicParameters) {
        let model = -motion.model_speed();
        if model < TELLING_SPEED {
            return;
        }
        let excess = (-motion.bias()).limited(-model, model);
        // Speeds in units of 64 um/s: the ECU then divides 32 bits instead of 64.
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
