//! The codes of all converters in a millisecond, and what each of them measures.

use super::adc_code::AdcCode;

/// Quantity of a converter channel, in the order of [`Samples::codes`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Signal {
    /// [`Samples::rocker_angle`].
    RockerAngle,
    /// [`Samples::lever`].
    Lever,
    /// [`Samples::upper_limit`].
    UpperLimit,
    /// [`Samples::lowering_dial`].
    LoweringDial,
    /// [`Samples::lift_current`].
    LiftCurrent,
    /// [`Samples::lower_current`].
    LowerCurrent,
    /// [`Samples::supply`].
    Supply,
    /// [`Samples::cylinder_pressure`].
    CylinderPressure,
    /// [`Samples::pump_pressure`].
    PumpPressure,
    /// [`Samples::second_angle`].
    SecondAngle,
    /// [`Samples::sensor_supply`].
    SensorSupply,
    /// [`Samples::reference`].
    Reference,
    /// [`Samples::left_pin`].
    LeftPin,
    /// [`Samples::right_pin`].
    RightPin,
    /// [`Samples::depth_sensor`].
    DepthSensor,
    /// [`Samples::mix_dial`].
    MixDial,
    /// [`Samples::set_point_dial`].
    SetPointDial,
}

/// Codes of all converters in a millisecond.
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
    /// Second track of the rocker-arm angle, inverted.
    pub second_angle: AdcCode,
    /// Supply of the sensors.
    pub sensor_supply: AdcCode,
    /// Internal band gap: its code falls when the converters' reference rises.
    pub reference: AdcCode,
    /// Left draft pin.
    pub left_pin: AdcCode,
    /// Right draft pin.
    pub right_pin: AdcCode,
    /// External depth sensor.
    pub depth_sensor: AdcCode,
    /// Mix dial.
    pub mix_dial: AdcCode,
    /// Dial of the set point of draft or depth.
    pub set_point_dial: AdcCode,
}

impl Samples {
    /// Number of converter channels.
    pub const CHANNELS: usize = 17;

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
            self.second_angle,
            self.sensor_supply,
            self.reference,
            self.left_pin,
            self.right_pin,
            self.depth_sensor,
            self.mix_dial,
            self.set_point_dial,
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
            second_angle,
            sensor_supply,
            reference,
            left_pin,
            right_pin,
            depth_sensor,
            mix_dial,
            set_point_dial,
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
            second_angle,
            sensor_supply,
            reference,
            left_pin,
            right_pin,
            depth_sensor,
            mix_dial,
            set_point_dial,
        }
    }
}
