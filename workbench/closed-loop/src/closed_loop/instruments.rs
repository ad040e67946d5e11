//! Typical sensors and current measurement of a tractor: noisy, quantised, reproducible by seed.

use hitch_plant::{Currents, Reading, SensorNoise};
use hitch_quantities::Inputs;
use hitch_quantities::units::{MilliAmp, MilliBar, MilliCelsius, MilliDegree, MilliVolt};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
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
    noise: SensorNoise,
    oil_temperature_c: f64,
}

impl Instruments {
    /// Instruments with this noise, from `seed`.
    #[must_use]
    pub fn new(noise: &SensorNoise, seed: u64, oil_temperature_c: f64) -> Self {
        Self {
            random: Pcg64Mcg::seed_from_u64(seed),
            noise: noise.clone(),
            oil_temperature_c,
        }
    }

    /// Changes the oil temperature, C.
    pub fn set_oil_temperature_c(&mut self, oil_temperature_c: f64) {
        self.oil_temperature_c = oil_temperature_c;
    }

    /// The controller's inputs for the state `truth` and the coil `currents`, with the lever at `lever_deg`.
    pub fn read(&mut self, truth: &Reading, currents: Currents, lever_deg: f64) -> Inputs {
        let sensors = &self.noise;
        let milli = |value: f64| (value * 1e3).round() as i32;
        let mut read = |value: f64, sigma: f64, step: f64| {
            let noise: f64 = StandardNormal.sample(&mut self.random);
            milli(quantised(value + sigma * noise, step))
        };
        let [lift_ma, lower_ma] = [currents.lift_a, currents.lower_a]
            .map(|true_a| read(true_a, sensors.current_a, CURRENT_STEP_A));
        let angle = read(
            truth.rocker_angle_deg,
            sensors.rocker_angle_deg,
            ANGLE_STEP_DEG,
        );
        let mut bar = |true_bar, sigma| MilliBar(read(true_bar, sigma, PRESSURE_STEP_BAR));
        let cylinder_pressure = bar(truth.cylinder_pressure_bar, sensors.cylinder_pressure_bar);
        let pump_pressure = bar(truth.pump_pressure_bar, sensors.pump_pressure_bar);
        Inputs {
            lever: Some(MilliDegree(milli(lever_deg))),
            rocker_angle: Some(MilliDegree(angle)),
            cylinder_pressure: Some(cylinder_pressure),
            pump_pressure: Some(pump_pressure),
            oil_temperature: Some(MilliCelsius(milli(self.oil_temperature_c))),
            supply: Some(MilliVolt(milli(SUPPLY_V))),
            lift_current: Some(MilliAmp(lift_ma)),
            lower_current: Some(MilliAmp(lower_ma)),
            ..Inputs::default()
        }
    }
}

fn quantised(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}
