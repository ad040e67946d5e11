//! From the output of an external depth sensor to the depth, with the plausibility of the sensor.
//!
//! ```text
//! depth = (output - zero) span / (supply / 4)
//! ```

use hitch_quantities::calibration::field_parameters::{DepthParameters, DraftParameters};
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::Micrometre;
use hitch_quantities::{Inputs, Trouble};

use super::noise_check::NoiseCheck;
use super::soil_sensor::{Signal, SoilSensor, Still};

/// A quarter of the supply, as of a pin.
const QUARTER: Divisor = Divisor::at_least_one(25_000);

/// Depth sensor from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct DepthSignal {
    noise: NoiseCheck,
    still: Still,
    sensor: SoilSensor,
}

impl DepthSignal {
    /// One step. Output range and times are those of the pins.
    pub fn step(
        &mut self,
        inputs: &Inputs,
        pins: &DraftParameters,
        parameters: &DepthParameters,
    ) -> Signal<Micrometre> {
        let range = pins.output_min..=pins.output_max;
        let still = self.still.step(inputs.depth_sensor);
        let depth = inputs
            .depth_sensor
            .filter(|output| range.contains(output))
            .map(|output| mul_div((output - parameters.zero).0, parameters.span.0, QUARTER))
            .ok_or(Trouble::DepthRange)
            .and_then(|depth| {
                let is_noisy = self.noise.is_noisy(depth, parameters.noise_limit.0);
                (!is_noisy).then_some(depth).ok_or(Trouble::DepthNoisy)
            });
        let still = (still, Trouble::DepthFrozen);
        let soil = [parameters.dead_band.0, 0];
        self.sensor
            .step(depth, still, parameters.filter, soil, pins)
            .map_or_else(|signal| signal, |depth| Signal::Measured(Micrometre(depth)))
    }

    /// Whether the implement is in the soil: from the dead band of the depth until it has left the ground.
    #[must_use]
    pub const fn is_in_soil(&self) -> bool {
        self.sensor.is_in_soil()
    }
}

#[cfg(test)]
mod tests {
    use hitch_quantities::units::SupplyShare;

    use super::*;

    const PINS: DraftParameters = DraftParameters::NOMINAL;
    const PARAMETERS: DepthParameters = DepthParameters::NOMINAL;

    struct Sensor {
        signal: DepthSignal,
        parameters: DepthParameters,
        step: i32,
    }

    impl Sensor {
        fn new() -> Self {
            Self {
                signal: DepthSignal::default(),
                parameters: PARAMETERS,
                step: 0,
            }
        }

        /// Steps with an output whose last bits change by up to `noise`; the last depth.
        fn run(&mut self, steps: i32, output: Option<i32>, noise: i32) -> Signal<Micrometre> {
            let mut depth = Signal::Suspect;
            for _ in 0..steps {
                self.step += 1;
                let digit = self.step % 7 - 3;
                let inputs = Inputs {
                    depth_sensor: output.map(|output| SupplyShare(output + noise * digit)),
                    ..Inputs::default()
                };
                depth = self.signal.step(&inputs, &PINS, &self.parameters);
            }
            depth
        }
    }

    fn millimetre(depth: Signal<Micrometre>) -> i32 {
        depth.measured().expect("is measured").0 / 1_000
    }

    #[test]
    fn the_depth_follows_from_zero_and_span_also_of_an_inverted_sensor() {
        let depth = millimetre(Sensor::new().run(2_000, Some(56_250), 1));
        assert!((depth - 250).abs() <= 1, "{depth} mm");
        let mut inverted = Sensor::new();
        inverted.parameters.zero = SupplyShare(75_000);
        inverted.parameters.span = Micrometre(-200_000);
        let depth = millimetre(inverted.run(2_000, Some(43_750), 1));
        assert!((depth - 250).abs() <= 1, "{depth} mm");
    }

    #[test]
    fn a_missing_or_impossible_output_is_lost_after_the_check_time() {
        for bad in [None, Some(0), Some(99_500)] {
            let mut sensor = Sensor::new();
            let before = millimetre(sensor.run(1_000, Some(56_250), 1));
            assert_eq!(sensor.run(PINS.check_time.0 - 1, bad, 0), Signal::Suspect);
            let lost = Signal::Lost(Trouble::DepthRange);
            assert_eq!(sensor.run(1, bad, 0), lost);
            assert_eq!(sensor.run(PINS.healthy_time.0 - 1, Some(56_250), 1), lost);
            let after = millimetre(sensor.run(100, Some(56_250), 1));
            assert!((after - before).abs() <= 1, "{before} and {after} mm");
        }
    }

    #[test]
    fn an_output_that_stands_still_is_lost_in_the_soil_and_used_above_it() {
        let mut sensor = Sensor::new();
        sensor.run(1_000, Some(56_250), 1);
        assert_eq!(sensor.run(100, Some(56_250), 0), Signal::Suspect);
        let found = sensor.run(PINS.frozen_time.0, Some(56_250), 0);
        assert_eq!(found, Signal::Lost(Trouble::DepthFrozen));
        let mut raised = Sensor::new();
        assert_eq!(millimetre(raised.run(5_000, Some(25_000), 0)), 0);
    }

    #[test]
    fn a_noisy_sensor_is_lost() {
        let mut sensor = Sensor::new();
        let quiet = millimetre(sensor.run(1_000, Some(56_250), 100));
        assert!((249..=251).contains(&quiet), "{quiet} mm");
        let lost = Signal::Lost(Trouble::DepthNoisy);
        assert_eq!(sensor.run(1_000, Some(56_250), 10_000), lost);
        let quiet = millimetre(sensor.run(3_000, Some(56_250), 100));
        assert!((249..=251).contains(&quiet), "{quiet} mm");
    }

    #[test]
    fn soil_is_entered_at_the_dead_band_and_left_at_the_ground() {
        let mut sensor = Sensor::new();
        let mut is_in_soil = |millimetre: i32| {
            sensor.run(2_000, Some(25_000 + millimetre * 125), 1);
            sensor.signal.is_in_soil()
        };
        assert_eq!(
            [10, 18, 5, -5, 10].map(&mut is_in_soil),
            [false, true, true, false, false]
        );
    }
}
