//! From converter codes to quantities.
//!
//! Twelve bits over a reference of 3.3 V, behind dividers that bring 5 V to full scale. The sensors are ratiometric and
//! give 0.5 to 4.5 V, so that a broken wire and a short are outside. Nothing here can be taught: what a machine's
//! sensor is off by is in the calibration's linkage.

use crate::control::Inputs;
use crate::control::units::{MilliAmp, MilliBar, MilliDegree, MilliVolt, PerMille};

/// A code of the converter: 0 to 4095.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct AdcCode(u16);

impl AdcCode {
    /// Full scale.
    pub const MAX: Self = Self(4095);

    /// The code of a converter's data register; the bits above the twelfth are dropped.
    #[must_use]
    pub const fn new(register: u16) -> Self {
        Self(register & Self::MAX.0)
    }

    /// The code as a number.
    #[must_use]
    pub const fn get(self) -> u16 {
        self.0
    }

    const fn wide(self) -> i32 {
        self.0 as i32
    }
}

/// A ratiometric signal outside 0.25 to 4.75 V: a broken wire or a short, and no sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WireFault;

/// A ratiometric signal in its healthy range: 0 at 0.5 V, 32 768 at 4.5 V.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Ratio(i32);

impl TryFrom<AdcCode> for Ratio {
    type Error = WireFault;

    fn try_from(code: AdcCode) -> Result<Self, WireFault> {
        /// Code at 0.25 and at 4.75 V of 5 V.
        const HEALTHY: core::ops::RangeInclusive<i32> = 205..=3_890;
        match HEALTHY.contains(&code.wide()) {
            true => Ok(Self(code.wide() * 10 - 4_096)),
            false => Err(WireFault),
        }
    }
}

impl Ratio {
    const ONE: i32 = 32_768;

    /// The same share of the way from `low` to `high`, which may be 65 000 apart.
    const fn between(self, low: i32, high: i32) -> i32 {
        low + ((high - low) * self.0 + Self::ONE / 2) / Self::ONE
    }
}

/// Angle of rocker or lever: 35 to 145 degrees.
impl TryFrom<AdcCode> for MilliDegree {
    type Error = WireFault;

    fn try_from(code: AdcCode) -> Result<Self, WireFault> {
        // In steps of 5 millidegrees, so that the product fits.
        Ratio::try_from(code).map(|ratio| Self(ratio.between(7_000, 29_000) * 5))
    }
}

/// Pressure: 0 to 250 bar.
impl TryFrom<AdcCode> for MilliBar {
    type Error = WireFault;

    fn try_from(code: AdcCode) -> Result<Self, WireFault> {
        Ratio::try_from(code).map(|ratio| Self(ratio.between(0, 50_000) * 5))
    }
}

/// Dial: shut at 0.5 V, open at 4.5 V.
impl TryFrom<AdcCode> for PerMille {
    type Error = WireFault;

    fn try_from(code: AdcCode) -> Result<Self, WireFault> {
        Ratio::try_from(code).map(|ratio| Self(ratio.between(0, 1_000).clamp(0, 1_000)))
    }
}

/// Coil current: a shunt and its amplifier bring 5 A to full scale. Twelve bits of it are never wrong by themselves.
impl From<AdcCode> for MilliAmp {
    fn from(code: AdcCode) -> Self {
        Self((code.wide() * 5_000 + 2_048) / 4_096)
    }
}

/// Supply: a divider of 7.448 brings 24.576 V to full scale, 6 mV a code.
impl From<AdcCode> for MilliVolt {
    fn from(code: AdcCode) -> Self {
        Self(code.wide() * 6)
    }
}

/// What the converters give in a millisecond.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Samples {
    /// Rocker-arm angle.
    pub rocker_angle: AdcCode,
    /// Lever.
    pub lever: AdcCode,
    /// Upper-limit dial.
    pub upper_limit: AdcCode,
    /// Lowering-rate dial.
    pub lowering_dial: AdcCode,
    /// Current of the lift coil.
    pub lift_current: AdcCode,
    /// Current of the lowering coil.
    pub lower_current: AdcCode,
    /// Supply voltage.
    pub supply: AdcCode,
    /// Cylinder pressure.
    pub cylinder_pressure: AdcCode,
    /// Pump pressure.
    pub pump_pressure: AdcCode,
}

impl Samples {
    /// Number of converter channels.
    pub const CHANNELS: usize = 9;

    /// The codes in the order of the fields.
    #[must_use]
    pub const fn codes(&self) -> [AdcCode; Self::CHANNELS] {
        [
            self.rocker_angle,
            self.lever,
            self.upper_limit,
            self.lowering_dial,
            self.lift_current,
            self.lower_current,
            self.supply,
            self.cylinder_pressure,
            self.pump_pressure,
        ]
    }

    /// The samples whose [`codes`](Self::codes) these are.
    #[must_use]
    pub const fn from_codes(codes: [AdcCode; Self::CHANNELS]) -> Self {
        let [
            rocker_angle,
            lever,
            upper_limit,
            lowering_dial,
            lift_current,
            lower_current,
            supply,
            cylinder_pressure,
            pump_pressure,
        ] = codes;
        Self {
            rocker_angle,
            lever,
            upper_limit,
            lowering_dial,
            lift_current,
            lower_current,
            supply,
            cylinder_pressure,
            pump_pressure,
        }
    }

    /// The inputs of a step, as far as converters know them. A dial whose wire is broken counts as its safest
    /// position: no lowering, and no limit beyond the calibration's, for a hitch that can't be raised is stuck.
    #[must_use]
    pub fn inputs(&self) -> Inputs {
        Inputs {
            lever: self.lever.try_into().ok(),
            rocker_angle: self.rocker_angle.try_into().ok(),
            cylinder_pressure: self.cylinder_pressure.try_into().ok(),
            pump_pressure: self.pump_pressure.try_into().ok(),
            supply: Some(self.supply.into()),
            upper_limit: self.upper_limit.try_into().ok(),
            lowering_dial: Some(self.lowering_dial.try_into().unwrap_or(PerMille::ZERO)),
            lift_current: Some(self.lift_current.into()),
            lower_current: Some(self.lower_current.into()),
            ..Inputs::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    /// The code of a voltage on the 5 V scale.
    fn code_at(volts: f64) -> AdcCode {
        AdcCode::new((volts / 5.0 * 4096.0).round() as u16)
    }

    #[test]
    fn a_ratiometric_angle_runs_from_half_a_volt_to_four_and_a_half() {
        let angle = |volts| MilliDegree::try_from(code_at(volts)).map(|angle| angle.0);
        // A code is 34 millidegrees.
        for (volts, millidegrees) in [(0.5, 35_000), (2.5, 90_000), (4.5, 145_000)] {
            let found = angle(volts).unwrap();
            assert!((found - millidegrees).abs() <= 17, "{volts} V: {found}");
        }
        assert_eq!(
            [angle(0.2), angle(4.8)],
            [Err(WireFault), Err(WireFault)],
            "a broken wire and a short"
        );
    }

    #[test]
    fn every_code_gives_more_than_the_one_before() {
        let angles: Vec<_> = (205..=3_890)
            .map(|code| MilliDegree::try_from(AdcCode::new(code)).unwrap())
            .collect();
        assert!(angles.is_sorted_by(|low, high| low < high));
        let currents: Vec<MilliAmp> = (0..4_096).map(|code| AdcCode::new(code).into()).collect();
        assert!(currents.is_sorted_by(|low, high| low < high));
        assert_eq!(currents[2_048], MilliAmp(2_500));
    }

    #[test]
    fn a_broken_dial_lowers_nothing() {
        let healthy = Samples::from_codes([code_at(2.5); Samples::CHANNELS]);
        assert_eq!(healthy.inputs().lowering_dial, Some(PerMille(500)));
        let broken = Samples {
            lowering_dial: AdcCode::default(),
            ..healthy
        };
        assert_eq!(broken.inputs().lowering_dial, Some(PerMille::ZERO));
    }

    #[test]
    fn codes_go_round() {
        let codes = core::array::from_fn(|index| AdcCode::new(index as u16 * 100));
        assert_eq!(Samples::from_codes(codes).codes(), codes);
    }
}
