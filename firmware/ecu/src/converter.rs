//! Converts converter codes into quantities.
//!
//! The sensors are ratiometric: their range is 10 to 90 % of the sensor supply, so that a broken or shorted wire is
//! outside. Their signals are divided by the measured sensor supply and are independent of drifts of that supply and of
//! the converters' reference. Currents and voltages are absolute. They are corrected by the internal band gap, whose
//! code falls when the reference rises. There are no machine-specific corrections here: the error of an angle sensor is
//! in the calibration's linkage.

use hitch_quantities::Inputs;
use hitch_quantities::units::{MilliAmp, MilliBar, MilliDegree, MilliVolt, PerMille, SupplyShare};

use super::adc_code::AdcCode;
use super::samples::Samples;
use super::scaling::BoardScaling;

/// A ratiometric signal in its healthy range: 0 at 10 % of the sensor supply, 32 768 at 90 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Ratio(i32);

impl Ratio {
    const ONE: i32 = 32_768;

    /// Linear interpolation between `low` and `high`, which may be 65 000 apart.
    const fn between(self, low: i32, high: i32) -> i32 {
        let part = (high - low).saturating_mul(self.0);
        low.saturating_add(part.saturating_add(Self::ONE / 2) / Self::ONE)
    }

    /// Angle of rocker or lever: 35 to 145 degrees, in steps of 5 millidegrees so that the product fits.
    const fn angle(self) -> MilliDegree {
        MilliDegree(self.between(7_000, 29_000).saturating_mul(5))
    }

    /// Angle of an inverted track.
    const fn inverted_angle(self) -> MilliDegree {
        MilliDegree(self.between(29_000, 7_000).saturating_mul(5))
    }

    /// Pressure: 0 to 250 bar.
    const fn pressure(self) -> MilliBar {
        MilliBar(self.between(0, 50_000).saturating_mul(5))
    }

    /// Dial: closed at 10 %, open at 90 %.
    fn dial(self) -> PerMille {
        PerMille(self.between(0, 1_000).clamp(0, 1_000))
    }
}

/// Unit of the correction factor of absolute readings.
const UNCORRECTED: u32 = 1 << 16;
/// Hysteresis of the sensor supply's code. Its last digit flips in a healthy machine, and would add noise to every
/// ratiometric signal.
const SUPPLY_STEP: u16 = 2;
/// Largest relative deviation of a code from its nominal value: beyond it the measurement itself is faulty, and its row
/// of the safety envelope trips.
const MOST_DEVIATION: u32 = 5;

/// Converts the codes of each millisecond into the inputs of a step.
#[derive(Clone, Copy, Debug)]
pub struct Conversion {
    scaling: BoardScaling,
    /// Code of the sensor supply for the division of the ratiometric signals.
    sensor_supply: u16,
    /// Ratio of a signal's code to 40 960 times its share of the sensor supply, in 2^-16.
    signal_factor: u32,
}

impl Conversion {
    /// The conversion of a board.
    #[must_use]
    pub fn new(scaling: BoardScaling) -> Self {
        Self {
            scaling,
            sensor_supply: 0,
            signal_factor: 10 << 16,
        }
    }

    /// The inputs of a step that come from converters. A dial with a broken wire counts as its safest position: no
    /// lowering; but no upper limit besides the calibrated one, so that the hitch can still be raised.
    #[must_use]
    pub fn inputs(&mut self, samples: &Samples) -> Inputs {
        let correction = self.correction(samples.reference);
        let sensor_supply = absolute(
            samples.sensor_supply,
            self.scaling.sensor_supply.0,
            correction,
        );
        self.follow_sensor_supply(samples.sensor_supply, sensor_supply);
        let ratio = |code| self.ratio(code);
        let current = |code| MilliAmp(absolute(code, self.scaling.current.0, correction));
        Inputs {
            lever: ratio(samples.lever).map(Ratio::angle),
            rocker_angle: ratio(samples.rocker_angle).map(Ratio::angle),
            second_angle: ratio(samples.second_angle).map(Ratio::inverted_angle),
            cylinder_pressure: ratio(samples.cylinder_pressure).map(Ratio::pressure),
            pump_pressure: ratio(samples.pump_pressure).map(Ratio::pressure),
            upper_limit: ratio(samples.upper_limit).map(Ratio::angle),
            lowering_dial: Some(ratio(samples.lowering_dial).map_or(PerMille::ZERO, Ratio::dial)),
            supply: Some(MilliVolt(absolute(
                samples.supply,
                self.scaling.supply.0,
                correction,
            ))),
            lift_current: Some(current(samples.lift_current)),
            lower_current: Some(current(samples.lower_current)),
            sensor_supply: Some(MilliVolt(sensor_supply)),
            reference: Some(self.reference(samples.reference)),
            left_pin: self.share(samples.left_pin),
            right_pin: self.share(samples.right_pin),
            depth_sensor: self.share(samples.depth_sensor),
            mix: ratio(samples.mix_dial).map(Ratio::dial),
            ..Inputs::default()
        }
    }

    /// Position of the dial of the set point of draft or depth; `None` if its wire is broken or shorted.
    #[must_use]
    pub fn set_point_dial(&self, samples: &Samples) -> Option<PerMille> {
        self.ratio(samples.set_point_dial).map(Ratio::dial)
    }

    /// The converters' reference by the band gap, per mille of its nominal value; 0 without band gap.
    fn reference(&self, band_gap: AdcCode) -> PerMille {
        let nominal = u32::from(self.scaling.reference.get()) * 1_000;
        let share = nominal
            .checked_div(u32::from(band_gap.get()))
            .unwrap_or_default();
        PerMille(share.cast_signed())
    }

    /// The factor of absolute readings in 2^-16; 1 if the code of the band gap is implausible.
    fn correction(&self, band_gap: AdcCode) -> u32 {
        let nominal = u32::from(self.scaling.reference.get());
        let measured = u32::from(band_gap.get());
        if measured.abs_diff(nominal) > nominal / MOST_DEVIATION {
            return UNCORRECTED;
        }
        (nominal * UNCORRECTED)
            .checked_div(measured)
            .unwrap_or(UNCORRECTED)
    }

    /// Updates the sensor supply for the ratiometric signals, unless it is implausible.
    fn follow_sensor_supply(&mut self, code: AdcCode, millivolts: i32) {
        let most = MilliVolt(NOMINAL_SENSOR_SUPPLY.0 / MOST_DEVIATION.cast_signed());
        let absurd = (MilliVolt(millivolts) - NOMINAL_SENSOR_SUPPLY).magnitude() > most;
        if absurd || code.get().abs_diff(self.sensor_supply) < SUPPLY_STEP {
            return;
        }
        let full_scale = |value: MilliVolt| u64::from(value.0.unsigned_abs());
        let signal = full_scale(self.scaling.signal) * (40_960 << 16);
        let supply = full_scale(self.scaling.sensor_supply) * u64::from(code.get());
        let factor = signal.checked_div(supply).unwrap_or_default();
        self.sensor_supply = code.get();
        self.signal_factor = u32::try_from(factor).unwrap_or(u32::MAX);
    }

    /// A ratiometric signal; `None` if its wire is broken or shorted.
    fn ratio(&self, code: AdcCode) -> Option<Ratio> {
        self.healthy(code)
            .map(|share| Ratio(share.saturating_sub(SUPPLY / 10)))
    }

    /// Output of a sensor whose zero and span are calibrated; `None` if its wire is broken or shorted.
    fn share(&self, code: AdcCode) -> Option<SupplyShare> {
        let share = self.healthy(code)?;
        // 100 000 are the supply.
        Some(SupplyShare(
            share.saturating_mul(625).saturating_add(128) >> 8,
        ))
    }

    /// The share of the sensor supply in parts of [`SUPPLY`], if it is within the limits of a healthy wire.
    fn healthy(&self, code: AdcCode) -> Option<i32> {
        let product = u64::from(code.get()) * u64::from(self.signal_factor);
        let share = i32::try_from(product >> 16).unwrap_or(i32::MAX);
        let part = |limit: PerMille| limit.0.clamp(0, 1_000) * SUPPLY / 1_000;
        let healthy = part(self.scaling.wire_min)..=part(self.scaling.wire_max);
        healthy.contains(&share).then_some(share)
    }
}

/// The sensor supply in the unit of a ratiometric signal.
const SUPPLY: i32 = 40_960;
/// Nominal supply of the sensors.
const NOMINAL_SENSOR_SUPPLY: MilliVolt = MilliVolt(5_000);

/// An absolute quantity: the corrected fraction of its full scale.
fn absolute(code: AdcCode, full_scale: i32, correction: u32) -> i32 {
    let share = (i64::from(code.wide()) * i64::from(full_scale) + 2_048) >> 12;
    let corrected = share.wrapping_mul(i64::from(correction)) >> 16;
    i32::try_from(corrected).unwrap_or(i32::MAX)
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::samples::Signal;

    /// Samples with signals at `volts`, a sensor supply of `sensor_supply` volts, and a reference at `share` of its
    /// nominal value.
    fn samples(volts: f64, sensor_supply: f64, share: f64) -> Samples {
        let code =
            |of_full_scale: f64| AdcCode::new((of_full_scale / share * 4096.0).round() as u16);
        Samples {
            supply: code(12.0 / 24.576),
            lift_current: code(0.5),
            sensor_supply: code(sensor_supply / 6.6),
            reference: code(1_502.0 / 4096.0),
            ..Samples::from_codes([code(volts / 5.0); Samples::CHANNELS])
        }
    }

    fn inputs(samples: &Samples) -> Inputs {
        Conversion::new(BoardScaling::NOMINAL).inputs(samples)
    }

    #[test]
    fn a_ratiometric_angle_runs_from_a_tenth_of_the_sensor_supply_to_nine_tenths() {
        // One code is 34 millidegrees.
        for (volts, millidegrees) in [(0.5, 35_000), (2.5, 90_000), (4.5, 145_000)] {
            let found = inputs(&samples(volts, 5.0, 1.0));
            let (first, second) = (found.rocker_angle.unwrap().0, found.second_angle.unwrap().0);
            assert!((first - millidegrees).abs() <= 20, "{volts} V: {first}");
            assert!((first + second - 180_000).abs() <= 40, "{first} {second}");
        }
        for broken in [0.2, 4.8] {
            assert_eq!(inputs(&samples(broken, 5.0, 1.0)).rocker_angle, None);
        }
    }

    #[test]
    fn a_pin_is_its_share_of_the_sensor_supply_and_a_broken_wire_is_none() {
        // One code is 24 parts of 100 000.
        for (supply, share) in [(5.0, 0.5), (4.6, 0.25), (5.3, 0.75), (5.0, 0.9)] {
            let found = inputs(&samples(share * supply, supply, 1.0));
            for output in [found.left_pin, found.right_pin, found.depth_sensor] {
                let off = f64::from(output.unwrap().0) * 1e-5 - share;
                assert!(off.abs() < 6e-4, "{share} of {supply} V: {off} more");
            }
        }
        for broken in [0.2, 4.8] {
            let found = inputs(&samples(broken, 5.0, 1.0));
            let outputs = [found.left_pin, found.right_pin, found.depth_sensor];
            assert_eq!(outputs, [None; 3]);
            assert_eq!(found.mix, None);
        }
    }

    #[test]
    fn neither_the_reference_nor_the_sensor_supply_moves_a_reading() {
        for (supply, share) in [(5.0, 0.92), (5.0, 1.06), (4.6, 1.0), (5.3, 0.97)] {
            let found = inputs(&samples(0.7 * supply, supply, share));
            let angle = found.rocker_angle.unwrap().0;
            assert!((angle - 117_500).abs() < 60, "{supply} {share}: {angle}");
            let (coil, battery) = (found.lift_current.unwrap().0, found.supply.unwrap().0);
            assert!((coil - 2_500).abs() <= 5, "{coil}");
            assert!((battery - 12_000).abs() <= 15, "{battery}");
            let sensors = found.sensor_supply.unwrap().0;
            assert!(
                (f64::from(sensors) - supply * 1e3).abs() <= 8.0,
                "{sensors}"
            );
            let reference = found.reference.unwrap().0;
            assert!(
                (f64::from(reference) - share * 1e3).abs() <= 1.5,
                "{reference}"
            );
        }
    }

    #[test]
    fn absurd_codes_of_reference_and_sensor_supply_divide_nothing() {
        let mut conversion = Conversion::new(BoardScaling::NOMINAL);
        let healthy = samples(3.5, 5.0, 1.0);
        let before = conversion.inputs(&healthy);
        for absurd in [AdcCode::new(0), AdcCode::new(1), AdcCode::MAX] {
            let found = conversion.inputs(&Samples {
                sensor_supply: absurd,
                reference: absurd,
                ..healthy
            });
            assert_eq!(found.rocker_angle, before.rocker_angle);
            assert_eq!(found.lift_current, before.lift_current);
            assert_ne!(found.reference, before.reference);
        }
    }

    #[test]
    fn every_code_gives_more_than_the_one_before() {
        let mut conversion = Conversion::new(BoardScaling::NOMINAL);
        let found: Vec<_> = (205..=3_890)
            .map(|code| {
                conversion.inputs(&Samples {
                    rocker_angle: AdcCode::new(code),
                    lift_current: AdcCode::new(code),
                    ..samples(2.5, 5.0, 1.0)
                })
            })
            .collect();
        assert!(found.is_sorted_by(|low, high| low.rocker_angle < high.rocker_angle));
        assert!(found.is_sorted_by(|low, high| low.lift_current < high.lift_current));
    }

    #[test]
    fn a_broken_dial_lowers_nothing() {
        let healthy = samples(2.5, 5.0, 1.0);
        let dial = |samples| inputs(&samples).lowering_dial.unwrap().0;
        assert!((dial(healthy) - 500).abs() <= 1);
        let broken = Samples {
            lowering_dial: AdcCode::default(),
            ..healthy
        };
        assert_eq!(dial(broken), 0);
    }

    #[test]
    fn codes_go_round() {
        let codes = core::array::from_fn(|index| AdcCode::new(index as u16 * 100));
        assert_eq!(Samples::from_codes(codes).codes(), codes);
    }

    #[test]
    fn the_code_of_a_signal_is_its_sample() {
        const CODE: AdcCode = AdcCode::new(1_000);
        let none = Samples::default();
        #[rustfmt::skip]
        let samples = [
            (Signal::RockerAngle, Samples { rocker_angle: CODE, ..none }),
            (Signal::Lever, Samples { lever: CODE, ..none }),
            (Signal::UpperLimit, Samples { upper_limit: CODE, ..none }),
            (Signal::LoweringDial, Samples { lowering_dial: CODE, ..none }),
            (Signal::LiftCurrent, Samples { lift_current: CODE, ..none }),
            (Signal::LowerCurrent, Samples { lower_current: CODE, ..none }),
            (Signal::Supply, Samples { supply: CODE, ..none }),
            (Signal::CylinderPressure, Samples { cylinder_pressure: CODE, ..none }),
            (Signal::PumpPressure, Samples { pump_pressure: CODE, ..none }),
            (Signal::SecondAngle, Samples { second_angle: CODE, ..none }),
            (Signal::SensorSupply, Samples { sensor_supply: CODE, ..none }),
            (Signal::Reference, Samples { reference: CODE, ..none }),
            (Signal::LeftPin, Samples { left_pin: CODE, ..none }),
            (Signal::RightPin, Samples { right_pin: CODE, ..none }),
            (Signal::DepthSensor, Samples { depth_sensor: CODE, ..none }),
            (Signal::MixDial, Samples { mix_dial: CODE, ..none }),
            (Signal::SetPointDial, Samples { set_point_dial: CODE, ..none }),
        ];
        assert_eq!(samples.len(), Samples::CHANNELS);
        for (signal, expected) in samples {
            let mut codes = none.codes();
            codes[signal as usize] = CODE;
            assert_eq!(Samples::from_codes(codes), expected, "{signal:?}");
        }
    }
}
