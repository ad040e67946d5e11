//! Table of the measurements, the common source of the ECU's slots and of the description file.

use hitch_quantities::signals::charge::CoilCharge;
use hitch_quantities::{Inputs, Outputs, fnv};

use super::angle_noise::rms_deg_bits;

/// Storage of a measurement in its slot, little-endian.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Width {
    /// Unsigned, 8 bits.
    U8,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 32 bits.
    I32,
}

/// Description of one measurement for a tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeasurementInfo {
    /// Name without unit.
    pub name: &'static str,
    /// Suffix of the engineering unit.
    pub suffix: &'static str,
    /// Raw counts in one engineering unit.
    pub counts_per_unit: i32,
    /// Storage.
    pub width: Width,
    /// Whether the 32 bits are an IEEE 754 single-precision number; the limits are in raw counts in any case.
    pub is_float: bool,
    /// Smallest value, raw counts.
    pub min: i32,
    /// Largest value, raw counts.
    pub max: i32,
    /// Description.
    pub description: &'static str,
}

/// Storage of a measurement, and whether it is a single-precision number: the keywords of the table below.
mod form {
    use super::Width;

    pub const U8: (Width, bool) = (Width::U8, false);
    pub const U16: (Width, bool) = (Width::U16, false);
    pub const I16: (Width, bool) = (Width::I16, false);
    pub const U32: (Width, bool) = (Width::U32, false);
    pub const I32: (Width, bool) = (Width::I32, false);
    pub const F32: (Width, bool) = (Width::U32, true);
}

/// Values of the ECU besides the inputs and outputs of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct EcuState {
    /// Set point of an implement, per mille of the travel; -1: none.
    pub remote_set_point: i32,
    /// State of remote control: 0 idle, 1 requested, 2 consented, 3 active.
    pub remote_state: u8,
    /// Own address on the bus; 254: none.
    pub address: u8,
    /// Charge through the coils.
    pub charge: CoilCharge,
    /// Reason why the working page is not in use: 0 in use, else see [`super::pages::Applied`].
    pub calibration_state: u8,
    /// Longest step so far, us.
    pub longest_step_us: u16,
    /// Frames that were dropped because a queue was full.
    pub frames_dropped: u16,
    /// Squares of the angle's noise, see [`super::angle_noise::AngleNoise::sum_of_squares`].
    pub angle_squares: u32,
}

macro_rules! measurements {
    (
        $inputs:ident, $outputs:ident, $ecu:ident;
        $($(#[doc = $doc:literal])+
        $name:ident: $form:ident, $suffix:literal, $counts:literal, $min:literal ..= $max:literal = $value:expr;)+
    ) => {
        /// Descriptions, in the order of the slots.
        pub const INFO: &[MeasurementInfo] = &[
            $(MeasurementInfo {
                name: stringify!($name),
                suffix: $suffix,
                counts_per_unit: $counts,
                width: form::$form.0,
                is_float: form::$form.1,
                min: $min,
                max: $max,
                description: concat!($($doc),+),
            },)+
        ];

        /// Number of measurements.
        pub const COUNT: usize = INFO.len();

        impl Measurements {
            /// The measurements after a step.
            pub fn sample(&mut self, $inputs: &Inputs, $outputs: &Outputs, $ecu: &EcuState) {
                self.slots = [$($value,)+];
            }
        }
    };
}

/// A hash of the table, continued from `hash`.
#[must_use]
pub const fn hash(mut hash: u32) -> u32 {
    let mut index = 0;
    while index < INFO.len() {
        let info = &INFO[index];
        hash = fnv::text(hash, info.name);
        hash = fnv::text(hash, info.suffix);
        hash = fnv::number(hash, info.counts_per_unit);
        hash = fnv::number(hash, info.width as i32);
        hash = fnv::number(hash, info.is_float as i32);
        index += 1;
    }
    hash
}

/// A slot of four bytes for each measurement. A missing signal is 0; see `valid`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Measurements {
    slots: [i32; COUNT],
}

impl Default for Measurements {
    fn default() -> Self {
        Self { slots: [0; COUNT] }
    }
}

impl Measurements {
    /// The value in a slot.
    #[must_use]
    pub fn slot(&self, index: usize) -> Option<i32> {
        self.slots.get(index).copied()
    }
}

measurements! {
    inputs, outputs, ecu;
    /// State of the controller.
    state: U8, "", 1, 0..=255 = i32::from(outputs.state as u8);
    /// Fault, 0 for none.
    fault: U8, "", 1, 0..=255 = outputs.fault.map_or(0, |fault| i32::from(fault as u8));
    /// Row of the safety envelope that tripped, 0 for none.
    trip: U8, "", 1, 0..=255 = outputs.trip.map_or(0, |trip| i32::from(trip as u8));
    /// Bits 0 to 17: which inputs are there; from bit 22 on: switches; bit 30: fault of the enable line.
    valid: U32, "", 1, 0..=2_147_483_647 = inputs.valid_and_switches().cast_signed();
    /// Lever on the scale of the rocker angle.
    lever: I32, "deg", 1_000, -360_000..=360_000 = inputs.lever.map_or(0, |value| value.0);
    /// Rocker-arm angle.
    rocker_angle: I32, "deg", 1_000, -360_000..=360_000 = inputs.rocker_angle.map_or(0, |value| value.0);
    /// Set point that is being worked on.
    target: I32, "deg", 1_000, -360_000..=360_000 = outputs.target.0;
    /// Estimated piston travel.
    travel: I32, "mm", 1_000, -2_000_000..=2_000_000 = outputs.travel.0;
    /// Estimated piston speed, positive is up.
    speed: I32, "mm_per_s", 1_000, -2_000_000..=2_000_000 = outputs.speed.0;
    /// Piston speed asked of the valves.
    demanded_speed: I32, "mm_per_s", 1_000, -2_000_000..=2_000_000 = outputs.demanded_speed.0;
    /// Flow asked of the valves.
    demanded_flow: I32, "ul_per_s", 1, -10_000_000..=10_000_000 = outputs.demanded_flow.0;
    /// Pressure drop that the lowering map uses.
    drop: I32, "bar", 1_000, 0..=1_000_000 = outputs.drop.0;
    /// Current asked of the lift coil.
    lift_current: I16, "a", 1_000, 0..=5_000 = outputs.lift_current.0;
    /// Current asked of the lowering coil.
    lower_current: I16, "a", 1_000, 0..=5_000 = outputs.lower_current.0;
    /// Measured current of the lift coil.
    lift_current_measured: I16, "a", 1_000, -32_000..=32_000 = inputs.lift_current.map_or(0, |value| value.0);
    /// Measured current of the lowering coil.
    lower_current_measured: I16, "a", 1_000, -32_000..=32_000 = inputs.lower_current.map_or(0, |value| value.0);
    /// Charge through the lift coil, goes round; its rise over a time is the mean current, without dither.
    lift_charge: I32, "uc", 1, -2_147_483_647..=2_147_483_647 = ecu.charge.0[0];
    /// Charge through the lowering coil, likewise.
    lower_charge: I32, "uc", 1, -2_147_483_647..=2_147_483_647 = ecu.charge.0[1];
    /// Share of the supply for the lift coil.
    lift_duty: I32, "percent", 1_000, 0..=100_000 = outputs.lift_duty.0;
    /// Share of the supply for the lowering coil.
    lower_duty: I32, "percent", 1_000, 0..=100_000 = outputs.lower_duty.0;
    /// Cylinder pressure.
    cylinder_pressure: I32, "bar", 1_000, -10_000..=1_000_000 = inputs.cylinder_pressure.map_or(0, |value| value.0);
    /// Pump pressure.
    pump_pressure: I32, "bar", 1_000, -10_000..=1_000_000 = inputs.pump_pressure.map_or(0, |value| value.0);
    /// Oil temperature.
    oil_temperature: I32, "c", 1_000, -100_000..=300_000 = inputs.oil_temperature.map_or(0, |value| value.0);
    /// Supply voltage.
    supply: U16, "v", 1_000, 0..=65_535 = inputs.supply.map_or(0, |value| value.0);
    /// Upper-limit dial on the scale of the rocker angle.
    upper_limit: I32, "deg", 1_000, -360_000..=360_000 = inputs.upper_limit.map_or(0, |value| value.0);
    /// Lowering-rate dial.
    lowering_dial: U16, "percent", 10, 0..=1_000 = inputs.lowering_dial.map_or(0, |value| value.0);
    /// Engine speed.
    engine_speed: U16, "rpm", 1, 0..=10_000 = inputs.engine_speed.map_or(0, |value| value.0);
    /// Hold-to-run request, positive is up.
    jog: I32, "deg_per_s", 1_000, -200_000..=200_000 = inputs.jog.map_or(0, |value| value.0);
    /// Time since the last step began.
    step_time: I32, "us", 1, 0..=1_000_000 = inputs.step_time.map_or(0, |value| value.0);
    /// Set point of an implement over the travel; negative: none.
    remote_set_point: I16, "percent", 10, -10..=1_000 = ecu.remote_set_point;
    /// State of remote control: 0 idle, 1 requested, 2 consented, 3 active.
    remote_state: U8, "", 1, 0..=3 = i32::from(ecu.remote_state);
    /// Address on the bus; 254: none.
    address: U8, "", 1, 0..=254 = i32::from(ecu.address);
    /// Why the working page isn't in use; 0: it is.
    calibration_state: U8, "", 1, 0..=255 = i32::from(ecu.calibration_state);
    /// Longest step so far.
    longest_step: U16, "us", 1, 0..=65_535 = i32::from(ecu.longest_step_us);
    /// Draft without its noise, positive against the direction of travel; 0 without pins.
    draft: I32, "n", 1, -1_000_000..=1_000_000 = outputs.draft.map_or(0, |draft| draft.0);
    /// Output of the left draft pin over its supply; 0 without one. With nothing attached it is `draft.left_zero`.
    left_pin: U16, "percent", 100, 0..=10_000 = inputs.left_pin.map_or(0, |output| output.0 / 10);
    /// Output of the right draft pin over its supply.
    right_pin: U16, "percent", 100, 0..=10_000 = inputs.right_pin.map_or(0, |output| output.0 / 10);
    /// Output of the external depth sensor over its supply; 0 without one. With the share at the ground it is `depth.zero`.
    depth_sensor: U16, "percent", 100, 0..=10_000 = inputs.depth_sensor.map_or(0, |output| output.0 / 10);
    /// What determines the set point: 0 the lever, an implement or quick lift, 1 draft, 2 mix, 3 depth limit, 4 floor, 5 ceiling, 6 slip, 7 above the ground, 8 holds, 9 ride damping, 10 engages, 11 depth.
    set_point_reason: U8, "", 1, 0..=11 = outputs.reference.map_or(0, |reason| i32::from(reason as u8));
    /// Lost sensor of draft, depth or slip control: 0 none, 1 pin out of range, 2 pins disagree, 3 pin frozen, 4 ground speed, 5 wheel speed, 6 a speed frozen, 7 depth sensor out of range, 8 frozen, 9 noisy, 10 pin noisy.
    field_trouble: U8, "", 1, 0..=10 = outputs.trouble.map_or(0, |trouble| i32::from(trouble as u8));
    /// Frames that were dropped because a queue was full.
    frames_dropped: U16, "", 1, 0..=65_535 = i32::from(ecu.frames_dropped);
    /// Noise of the rocker angle, root mean square over the last second.
    angle_noise: F32, "deg", 1, 0..=1 = rms_deg_bits(ecu.angle_squares).cast_signed();
}
