//! Typical sensors and current measurement of a tractor: noisy, quantised, reproducible by seed.

use hitch_plant::{Currents, Reading, SensorNoise};
use hitch_quantities::Inputs;
use hitch_quantities::units::{MilliAmp, MilliBar, MilliCelsius, MilliDegree, MilliVolt};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Mcg;

/// Resolution of a 12-bit converter for an angle sensor with 0.5 to 4.5 V of 5 V over 110 degrees, degree.
const ANGLE_STEP_DEG: f64 = 110.0 / (0.8 * 4096.0);
/// Resolution of the same converter over 250 bar, bar.
const PRESSURE_STEP_BAR: f64 = 250.0 / (0.8 * 4096.0);
/// Resolution of the same converter over 5 A, A.
const CURRENT_STEP_A: f64 = 5.0 / 4096.0;
/// Supply with the engine running, V.
pub const SUPPLY_V: f64 = 13.8;

/// A set of instruments with its own random stream.
pub struct Instruments {
    random: Pcg64Mcg,
    angle: Normal<f64>,
    cylinder: Normal<f64>,
    pump: Normal<f64>,
    current: Normal<f64>,
    oil_temperature_c: f64,
}

impl Instruments {
    /// Instruments with this noise, from `seed`.
    #[must_use]
    pub fn new(noise: &SensorNoise, seed: u64, oil_temperature_c: f64) -> Self {
        let normal = |sigma| Normal::new(0.0, sigma).expect("a finite constant");
        Self {
            random: Pcg64Mcg::seed_from_u64(seed),
            angle: normal(noise.rocker_angle_deg),
            cylinder: normal(noise.cylinder_pressure_bar),
            pump: normal(noise.pump_pressure_bar),
            current: normal(noise.current_a),
            oil_temperature_c,
        }
    }

    /// Changes the oil temperature, C.
    pub fn set_oil_temperature_c(&mut self, oil_temperature_c: f64) {
        self.oil_temperature_c = oil_temperature_c;
    }

    /// The controller's inputs for the state `truth` and the coil `currents`, with the lever at `lever_deg`.
    pub fn read(&mut self, truth: &Reading, currents: Currents, lever_deg: f64) -> Inputs {
        let mut ampere = |true_a: f64| {
            let read_a = quantised(
                true_a + self.current.sample(&mut self.random),
                CURRENT_STEP_A,
            );
            MilliAmp((read_a * 1e3).round() as i32)
        };
        let (lift_current, lower_current) = (ampere(currents.lift_a), ampere(currents.lower_a));
        let angle_deg = truth.rocker_angle_deg + self.angle.sample(&mut self.random);
        let cylinder_bar = truth.cylinder_pressure_bar + self.cylinder.sample(&mut self.random);
        let pump_bar = truth.pump_pressure_bar + self.pump.sample(&mut self.random);
        let milli = |value: f64| (value * 1e3).round() as i32;
        Inputs {
            lever: Some(MilliDegree(milli(lever_deg))),
            rocker_angle: Some(MilliDegree(milli(quantised(angle_deg, ANGLE_STEP_DEG)))),
            cylinder_pressure: Some(MilliBar(milli(quantised(cylinder_bar, PRESSURE_STEP_BAR)))),
            pump_pressure: Some(MilliBar(milli(quantised(pump_bar, PRESSURE_STEP_BAR)))),
            oil_temperature: Some(MilliCelsius(milli(self.oil_temperature_c))),
            supply: Some(MilliVolt(milli(SUPPLY_V))),
            lift_current: Some(lift_current),
            lower_current: Some(lower_current),
            ..Inputs::default()
        }
    }
}

fn quantised(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}
