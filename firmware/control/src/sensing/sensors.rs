//! Sensor plausibility: selection of valid samples.
//!
//! Angle and lever are required: an invalid sample is replaced by the last valid one for a few steps, then it is a
//! fault. Pressures are optional: without a valid one the controller uses its estimate.

use hitch_quantities::calibration::design_parameters::SensorParameters;
use hitch_quantities::units::{MilliBar, MilliDegree, Millisecond};
use hitch_quantities::{Fault, Inputs};

/// Valid samples.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sensed {
    /// Set point: the lever's, or an implement's.
    pub set_point: MilliDegree,
    /// Rocker angle.
    pub angle: MilliDegree,
    /// Cylinder pressure, if it is valid.
    pub cylinder_pressure: Option<MilliBar>,
    /// Pump pressure, if it is valid.
    pub pump_pressure: Option<MilliBar>,
}

impl Sensed {
    /// With what the sensor of the cylinder shows without pressure taken off its reading.
    #[must_use]
    pub fn without_offset(self, offset: MilliBar) -> Self {
        Self {
            cylinder_pressure: self.cylinder_pressure.map(|pressure| pressure - offset),
            ..self
        }
    }
}

/// Watches the sensors from step to step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sensors {
    lever: Bridge,
    angle: Bridge,
}

impl Sensors {
    /// Checks the samples of one step.
    ///
    /// # Errors
    /// The fault of a required sensor that has been invalid for longer than the allowed gap.
    pub fn judge(
        &mut self,
        inputs: &Inputs,
        parameters: &SensorParameters,
    ) -> Result<Sensed, Fault> {
        let lever = in_range(inputs.lever, parameters.lever_min, parameters.lever_max);
        let angle = in_range(
            inputs.rocker_angle,
            parameters.angle_min,
            parameters.angle_max,
        );
        let angle = self.angle.without_jump(angle, parameters.angle_jump);
        // Both checks run in every step, so that one fault does not stop the other check.
        let lever = self
            .lever
            .judge(lever, parameters.bridged)
            .ok_or(Fault::Lever);
        let angle = self
            .angle
            .judge(angle, parameters.bridged)
            .ok_or(Fault::Angle);
        let pressure = |sample| in_range(sample, parameters.pressure_min, parameters.pressure_max);
        Ok(Sensed {
            angle: angle?,
            // An implement does not replace a faulty lever.
            set_point: lever.map(|lever| inputs.set_point.unwrap_or(lever))?,
            cylinder_pressure: pressure(inputs.cylinder_pressure),
            pump_pressure: pressure(inputs.pump_pressure),
        })
    }
}

fn in_range<T: Ord + Copy>(sample: Option<T>, low: T, high: T) -> Option<T> {
    sample.filter(|&value| low <= value && value <= high)
}

/// Bridges short gaps of a signal.
#[derive(Clone, Copy, Debug, Default)]
struct Bridge {
    last: Option<MilliDegree>,
    gap: Millisecond,
}

impl Bridge {
    /// Discards a sample that differs from the last valid one by more than `jump`; after a gap any sample is accepted.
    fn without_jump(&self, sample: Option<MilliDegree>, jump: MilliDegree) -> Option<MilliDegree> {
        sample.filter(|&value| {
            self.last
                .is_none_or(|last| (value - last).magnitude() <= jump)
        })
    }

    /// The sample, or the last good one while the gap is short.
    fn judge(&mut self, sample: Option<MilliDegree>, bridged: Millisecond) -> Option<MilliDegree> {
        if sample.is_some() {
            self.gap = Millisecond::ZERO;
            self.last = sample;
        } else {
            self.gap = self.gap.next();
            if self.gap > bridged {
                self.last = None;
            }
        }
        self.last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(angle: Option<i32>) -> Inputs {
        Inputs {
            lever: Some(MilliDegree(90_000)),
            rocker_angle: angle.map(MilliDegree),
            ..Inputs::default()
        }
    }

    #[test]
    fn a_short_gap_is_bridged_and_a_long_one_is_a_fault() {
        let parameters = SensorParameters::NOMINAL;
        let mut sensors = Sensors::default();
        assert!(sensors.judge(&sample(Some(80_000)), &parameters).is_ok());
        for step in 1..=parameters.bridged.0 {
            let sensed = sensors.judge(&sample(None), &parameters);
            assert_eq!(
                sensed.map(|sensed| sensed.angle),
                Ok(MilliDegree(80_000)),
                "step {step}"
            );
        }
        assert_eq!(sensors.judge(&sample(None), &parameters), Err(Fault::Angle));
    }

    #[test]
    fn the_offset_of_a_pressure_is_taken_off_after_its_range_is_checked() {
        let parameters = SensorParameters::NOMINAL;
        let judged = |shown: MilliBar| {
            let inputs = Inputs {
                cylinder_pressure: Some(shown),
                pump_pressure: Some(shown),
                ..sample(Some(80_000))
            };
            let sensed = Sensors::default().judge(&inputs, &parameters).unwrap();
            let sensed = sensed.without_offset(MilliBar(3_000));
            [sensed.cylinder_pressure, sensed.pump_pressure]
        };
        for shown in [MilliBar(0), MilliBar(50_000), parameters.pressure_max] {
            assert_eq!(judged(shown), [Some(shown - MilliBar(3_000)), Some(shown)]);
        }
        assert_eq!(judged(parameters.pressure_max + MilliBar(1)), [None; 2]);
    }

    #[test]
    fn a_jump_is_not_believed_until_it_has_been_a_fault() {
        let parameters = SensorParameters::NOMINAL;
        let mut sensors = Sensors::default();
        assert!(sensors.judge(&sample(Some(80_000)), &parameters).is_ok());
        let sensed = sensors.judge(&sample(Some(85_000)), &parameters);
        assert_eq!(sensed.map(|sensed| sensed.angle), Ok(MilliDegree(80_000)));
        for _ in 0..parameters.bridged.0 {
            let _ = sensors.judge(&sample(Some(85_000)), &parameters);
        }
        let sensed = sensors.judge(&sample(Some(85_000)), &parameters);
        assert_eq!(sensed.map(|sensed| sensed.angle), Ok(MilliDegree(85_000)));
    }

    #[test]
    fn out_of_range_is_no_sample() {
        let parameters = SensorParameters::NOMINAL;
        let mut sensors = Sensors::default();
        assert_eq!(
            sensors.judge(&sample(Some(20_000)), &parameters),
            Err(Fault::Angle)
        );
        let broken_lever = Inputs {
            lever: None,
            ..sample(Some(80_000))
        };
        assert_eq!(
            Sensors::default().judge(&broken_lever, &parameters),
            Err(Fault::Lever)
        );
    }
}
