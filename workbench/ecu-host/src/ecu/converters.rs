//! Converts quantities into converter codes, with the noise of sensors and wiring.

use std::ops::RangeInclusive;

use hitch_ecu::{AdcCode, BoardScaling, Samples};
use hitch_plant::SensorNoise;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

/// Range of the sensors of rocker, lever and upper-limit dial of the board, degree.
pub const SENSORS_DEG: RangeInclusive<f64> = 35.0..=145.0;
/// Supply of the sensors, V.
pub const SENSOR_SUPPLY_V: f64 = 5.0;
/// Number of codes of 12 bits.
const CODES: f64 = 4096.0;
/// One sigma of the noise of lever and dials: one code.
const POTENTIOMETER_NOISE: f64 = 1.0 / CODES;

/// The measured quantities.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Signals {
    /// Rocker angle, degree.
    pub rocker_angle_deg: f64,
    /// Lever on the scale of the rocker angle, degree.
    pub lever_deg: f64,
    /// Upper-limit dial on the scale of the rocker angle, degree.
    pub upper_limit_deg: f64,
    /// Lowering-rate dial, 0 to 1.
    pub lowering_dial: f64,
    /// Current in the lift coil, A.
    pub lift_current_a: f64,
    /// Current in the lowering coil, A.
    pub lower_current_a: f64,
    /// Supply, V.
    pub supply_v: f64,
    /// Cylinder pressure, bar.
    pub cylinder_pressure_bar: f64,
    /// Pump pressure, bar.
    pub pump_pressure_bar: f64,
    /// Supply of the sensors, V.
    pub sensor_supply_v: f64,
    /// Reference of the converters over its nominal value.
    pub reference: f64,
}

/// Sensors, wiring and converters; the noise is reproducible by seed.
#[derive(Debug)]
pub struct Converters {
    noise: SensorNoise,
    random: Pcg64Mcg,
}

impl Converters {
    /// Converters of sensors with this noise, from `seed`.
    pub fn new(noise: SensorNoise, seed: u64) -> Self {
        Self {
            noise,
            random: Pcg64Mcg::seed_from_u64(seed),
        }
    }

    /// The codes for one millisecond.
    pub fn convert(&mut self, signals: &Signals) -> Samples {
        let sensors = &self.noise;
        let mut noisy = |value: f64, sigma: f64| {
            let noise: f64 = StandardNormal.sample(&mut self.random);
            value + sigma * noise
        };
        let code = |of_full_scale: f64| code(of_full_scale / signals.reference);
        let full_scale = |millivolts: i32| f64::from(millivolts) * 1e-3;
        let full_scale_a = f64::from(BoardScaling::NOMINAL.current.0) * 1e-3;
        // 10 % to 90 % of the sensor supply: the range of the angle, 0 to 250 bar, closed to open.
        let signal = signals.sensor_supply_v / full_scale(BoardScaling::NOMINAL.signal.0);
        let ratiometric = |share: f64| code((0.1 + 0.8 * share) * signal);
        let (first_deg, last_deg) = (*SENSORS_DEG.start(), *SENSORS_DEG.end());
        let angle_deg =
            |angle_deg: f64| ratiometric((angle_deg - first_deg) / (last_deg - first_deg));
        Samples {
            rocker_angle: angle_deg(noisy(signals.rocker_angle_deg, sensors.rocker_angle_deg)),
            lever: angle_deg(noisy(signals.lever_deg, 110.0 * POTENTIOMETER_NOISE)),
            upper_limit: angle_deg(noisy(signals.upper_limit_deg, 110.0 * POTENTIOMETER_NOISE)),
            lowering_dial: ratiometric(noisy(signals.lowering_dial, POTENTIOMETER_NOISE)),
            lift_current: code(noisy(signals.lift_current_a, sensors.current_a) / full_scale_a),
            lower_current: code(noisy(signals.lower_current_a, sensors.current_a) / full_scale_a),
            supply: code(signals.supply_v / full_scale(BoardScaling::NOMINAL.supply.0)),
            cylinder_pressure: ratiometric(
                noisy(signals.cylinder_pressure_bar, sensors.cylinder_pressure_bar) / 250.0,
            ),
            pump_pressure: ratiometric(
                noisy(signals.pump_pressure_bar, sensors.pump_pressure_bar) / 250.0,
            ),
            second_angle: angle_deg(
                180.0 - noisy(signals.rocker_angle_deg, sensors.rocker_angle_deg),
            ),
            sensor_supply: code(
                signals.sensor_supply_v / full_scale(BoardScaling::NOMINAL.sensor_supply.0),
            ),
            reference: code(f64::from(BoardScaling::NOMINAL.reference.get()) / CODES),
            // This machine has neither draft pins nor a depth sensor nor their dials.
            ..Samples::default()
        }
    }
}

/// Codes of a share of a sensor's range, at the nominal supply of the sensors.
#[must_use]
pub fn ratiometric_codes(share: f64) -> f64 {
    let full_scale_v = f64::from(BoardScaling::NOMINAL.signal.0) * 1e-3;
    0.8 * share * SENSOR_SUPPLY_V / full_scale_v * CODES
}

/// The code for a fraction of full scale.
fn code(share: f64) -> AdcCode {
    AdcCode::new((share * CODES).round().clamp(0.0, CODES - 1.0) as u16)
}

#[cfg(test)]
mod tests {
    use hitch_ecu::Conversion;

    use super::*;

    #[test]
    fn the_firmware_reads_what_there_was_to_be_measured() {
        let signals = Signals {
            rocker_angle_deg: 87.3,
            lever_deg: 61.2,
            upper_limit_deg: 130.0,
            lowering_dial: 0.5,
            lift_current_a: 1.7,
            lower_current_a: 0.0,
            supply_v: 13.8,
            cylinder_pressure_bar: 43.0,
            pump_pressure_bar: 154.0,
            sensor_supply_v: 5.0,
            reference: 1.0,
        };
        let mut converters = Converters::new(SensorNoise::default(), 1);
        let mut conversion = Conversion::new(BoardScaling::NOMINAL);
        let inputs: Vec<_> = (0..2_000)
            .map(|_| conversion.inputs(&converters.convert(&signals)))
            .collect();
        let mean = |of: &dyn Fn(usize) -> i32| {
            (0..inputs.len())
                .map(|index| f64::from(of(index)))
                .sum::<f64>()
                / inputs.len() as f64
        };
        let close = |mean: f64, truth: f64, within: f64| {
            assert!((mean - truth).abs() < within, "{mean} instead of {truth}");
        };
        close(mean(&|i| inputs[i].rocker_angle.unwrap().0), 87_300.0, 10.0);
        close(mean(&|i| inputs[i].lever.unwrap().0), 61_200.0, 20.0);
        close(mean(&|i| inputs[i].lift_current.unwrap().0), 1_700.0, 2.0);
        close(mean(&|i| inputs[i].supply.unwrap().0), 13_800.0, 6.0);
        close(
            mean(&|i| inputs[i].cylinder_pressure.unwrap().0),
            43_000.0,
            20.0,
        );
        close(
            mean(&|i| inputs[i].pump_pressure.unwrap().0),
            154_000.0,
            20.0,
        );
    }
}
