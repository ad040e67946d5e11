//! The codes of all converters in a millisecond, and what each of them measures.

use super::adc_code::AdcCode;

/// [`Signal`] and [`Samples`] from one list of channels.
macro_rules! channels {
    ($($(#[$doc:meta])* $field:ident: $signal:ident,)*) => {
        /// Quantity of a converter channel, in the order of [`Samples::codes`].
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Signal {
            $($(#[$doc])* $signal,)*
        }

        /// Codes of all converters in a millisecond.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct Samples {
            $($(#[$doc])* pub $field: AdcCode,)*
        }

        impl Samples {
            /// Number of converter channels.
            pub const CHANNELS: usize = [$(Signal::$signal),*].len();

            /// The codes in the order of the fields.
            #[must_use]
            pub const fn codes(&self) -> [AdcCode; Self::CHANNELS] {
                [$(self.$field),*]
            }

            /// The samples whose [`codes`](Self::codes) these are.
            #[must_use]
            pub const fn from_codes(codes: [AdcCode; Self::CHANNELS]) -> Self {
                let [$($field),*] = codes;
                Self { $($field),* }
            }
        }
    };
}

channels! {
    /// Rocker-arm angle.
    rocker_angle: RockerAngle,
    /// Lever.
    lever: Lever,
    /// Upper-limit dial.
    upper_limit: UpperLimit,
    /// Lowering-rate dial.
    lowering_dial: LoweringDial,
    /// Current of the lift coil.
    lift_current: LiftCurrent,
    /// Current of the lowering coil.
    lower_current: LowerCurrent,
    /// Supply voltage.
    supply: Supply,
    /// Cylinder pressure.
    cylinder_pressure: CylinderPressure,
    /// Pump pressure.
    pump_pressure: PumpPressure,
    /// Second track of the rocker-arm angle, inverted.
    second_angle: SecondAngle,
    /// Supply of the sensors.
    sensor_supply: SensorSupply,
    /// Internal band gap: its code falls when the converters' reference rises.
    reference: Reference,
    /// Left draft pin.
    left_pin: LeftPin,
    /// Right draft pin.
    right_pin: RightPin,
    /// External depth sensor.
    depth_sensor: DepthSensor,
    /// Mix dial.
    mix_dial: MixDial,
    /// Dial of the set point of draft or depth.
    set_point_dial: SetPointDial,
}
