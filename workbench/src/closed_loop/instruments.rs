//! Sensors and current driver as a tractor has them: noisy, quantised, the same for the same seed.

use hitch_firmware::control::Inputs;
use hitch_firmware::control::units::{MilliAmp, MilliBar, MilliCelsius, MilliDegree, MilliVolt};
use hitch_model::plant::{Currents, Reading};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use rand_pcg::Pcg64Mcg;

/// One sigma of the angle sensor, degree.
const ANGLE_NOISE_DEG: f64 = 0.05;
/// One sigma of the cylinder pressure sensor, bar.
const CYLINDER_NOISE_BAR: f64 = 0.10;
/// One sigma of the pump pressure sensor, bar.
const PUMP_NOISE_BAR: f64 = 0.15;
/// Step of a 12-bit converter over the 0.5 to 4.5 V (of 5 V) that are 110 degrees, degree.
const ANGLE_STEP_DEG: f64 = 110.0 / (0.8 * 4096.0);
/// Step of the same converter over 250 bar, bar.
const PRESSURE_STEP_BAR: f64 = 250.0 / (0.8 * 4096.0);
/// Resolution of the current driver, A.
const CURRENT_STEP_A: f64 = 0.002;

/// A set of instruments with a random stream of its own.
pub struct Instruments {
    random: Pcg64Mcg,
    angle: Normal<f64>,
    cylinder: Normal<f64>,
    pump: Normal<f64>,
    oil_temperature_c: f64,
}

impl Instruments {
    /// Instruments whose noise is settled by `seed`.
    #[must_use]
    pub fn new(seed: u64, oil_temperature_c: f64) -> Self {
        let normal = |sigma| Normal::new(0.0, sigma).expect("a positive constant");
        Self {
            random: Pcg64Mcg::seed_from_u64(seed),
            angle: normal(ANGLE_NOISE_DEG),
            cylinder: normal(CYLINDER_NOISE_BAR),
            pump: normal(PUMP_NOISE_BAR),
            oil_temperature_c,
        }
    }

    /// What the controller is told of `truth`, with the lever at `lever_deg`.
    pub fn read(&mut self, truth: &Reading, lever_deg: f64) -> Inputs {
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
            supply: Some(MilliVolt(13_800)),
            ..Inputs::default()
        }
    }

    /// The current that a coil gets when the controller asks for `asked`.
    #[must_use]
    pub fn drive(lift: MilliAmp, lower: MilliAmp) -> Currents {
        let ampere = |asked: MilliAmp| quantised(f64::from(asked.0) * 1e-3, CURRENT_STEP_A);
        Currents {
            lift_a: ampere(lift),
            lower_a: ampere(lower),
        }
    }
}

fn quantised(value: f64, step: f64) -> f64 {
    (value / step).round() * step
}
