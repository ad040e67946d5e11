//! What goes into a step and what comes out, with fixed little-endian images for traces and links.

pub mod charge;
pub mod coils;
pub mod fault;
pub mod field;
pub mod trip;

use super::codes;
use super::image::Writer;
use super::units::{
    Count, Duty, MicroLitrePerSecond, Micrometre, MicrometrePerSecond, Microsecond, MilliAmp,
    MilliBar, MilliCelsius, MilliDegree, MilliDegreePerSecond, MilliVolt, MillimetrePerSecond,
    Millisecond, Newton, PerMille, RevolutionPerMinute, SupplyShare,
};
use fault::Fault;
use field::{Reason, Trouble};
use trip::Trip;

/// What the operator has switched on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Switches {
    /// Transport lock: nothing moves, and the lever has to pick the hitch up afterwards.
    pub transport_lock: bool,
    /// Hold: the hitch stays where it is whatever the lever does.
    pub hold: bool,
    /// Quick lift, a button: the first press raises, the next returns to the lever.
    pub quick_lift: bool,
    /// Service: with it, the button outside teaches a locked machine for as long as it is held.
    pub teach: bool,
    /// Consent to remote control, a button: its closing lets an implement that asks command the hitch.
    pub consent: bool,
    /// Second contact of the button up: closed while it is released. Without such a contact it does not count.
    pub up_released: bool,
    /// The same of the button down.
    pub down_released: bool,
    /// Quick engagement: lowers the implement into the soil while it is held.
    pub engage: bool,
}

impl Switches {
    /// The bit of the first one in the word of validity bits.
    const FIRST_BIT: u32 = 22;

    fn to_bits(self) -> u32 {
        [
            self.up_released,
            self.down_released,
            self.transport_lock,
            self.hold,
            self.quick_lift,
            self.teach,
            self.consent,
            self.engage,
        ]
        .into_iter()
        .rev()
        .fold(0, |bits, on| (bits << 1) | u32::from(on))
            << Self::FIRST_BIT
    }

    fn from_bits(word: u32) -> Self {
        let on = |index: u32| (word >> Self::FIRST_BIT) >> index & 1 == 1;
        Self {
            up_released: on(0),
            down_released: on(1),
            transport_lock: on(2),
            hold: on(3),
            quick_lift: on(4),
            teach: on(5),
            consent: on(6),
            engage: on(7),
        }
    }
}

/// One sample of everything the controller is told. `None`: not fitted, or no valid sample this time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Inputs {
    /// Lever set point on the rocker-angle scale.
    pub lever: Option<MilliDegree>,
    /// Hold-to-run request: rocker speed, positive is up; zero if both buttons are pressed, which moves nothing. While it
    /// is given, the lever has no say.
    pub jog: Option<MilliDegreePerSecond>,
    /// Rocker-arm angle.
    pub rocker_angle: Option<MilliDegree>,
    /// Cylinder pressure.
    pub cylinder_pressure: Option<MilliBar>,
    /// Pump pressure.
    pub pump_pressure: Option<MilliBar>,
    /// Oil temperature.
    pub oil_temperature: Option<MilliCelsius>,
    /// Supply voltage.
    pub supply: Option<MilliVolt>,
    /// Upper-limit dial on the rocker-angle scale: no set point goes beyond it.
    pub upper_limit: Option<MilliDegree>,
    /// Lowering-rate dial: 0 is shut, 1000 is open.
    pub lowering_dial: Option<PerMille>,
    /// Engine speed.
    pub engine_speed: Option<RevolutionPerMinute>,
    /// Measured current of the lift coil.
    pub lift_current: Option<MilliAmp>,
    /// Measured current of the lowering coil.
    pub lower_current: Option<MilliAmp>,
    /// Time since the last step began, by a clock that isn't the scheduler's.
    pub step_time: Option<Microsecond>,
    /// Rocker-arm angle by the sensor's second track.
    pub second_angle: Option<MilliDegree>,
    /// Supply of the sensors.
    pub sensor_supply: Option<MilliVolt>,
    /// Reference of the converters, per mille of its nominal value.
    pub reference: Option<PerMille>,
    /// Set point of an implement on the rocker-angle scale: it replaces the lever's.
    pub set_point: Option<MilliDegree>,
    /// Main clock by an independent oscillator, per mille of its rate at the start.
    pub clock_ratio: Option<PerMille>,
    /// Left draft pin.
    pub left_pin: Option<SupplyShare>,
    /// Right draft pin.
    pub right_pin: Option<SupplyShare>,
    /// Speed over the ground; only in the step in which it was received.
    pub ground_speed: Option<MillimetrePerSecond>,
    /// Speed of the driven wheels; only in the step in which it was received.
    pub wheel_speed: Option<MillimetrePerSecond>,
    /// Set point of the draft.
    pub draft_set_point: Option<Newton>,
    /// Mix dial: 0 is position, 1000 is draft.
    pub mix: Option<PerMille>,
    /// Slip limit of the operator.
    pub slip_limit: Option<PerMille>,
    /// External depth sensor; its output over its supply.
    pub depth_sensor: Option<SupplyShare>,
    /// Set point of the depth.
    pub depth_set_point: Option<Micrometre>,
    /// Code of the selected function ([`field::Function`]).
    pub function: Option<Count>,
    /// What the operator has switched on.
    pub switches: Switches,
    /// The enable line of the coils' drivers: its read-back differs from its command.
    pub enable_line_fault: bool,
}

codes! {
    /// State of the controller, with the code it has on links and in traces.
    #[derive(Default)]
    State: u8 {
        /// Nothing moves until the lever has been moved through the present position.
        #[default]
        Locked = 0, "locked";
        /// Resting on the check valve.
        Holding = 1, "holding";
        /// Lift coil on.
        Lifting = 2, "lifting";
        /// Lowering coil on.
        Lowering = 3, "lowering";
        /// Both coils off, waiting for the check valve to seat.
        Settling = 4, "settling";
        /// Flow was demanded and nothing moved: resting before the next attempt.
        Stalled = 5, "stalled";
        /// A fault keeps both coils off; see the fault code.
        Fault = 6, "fault";
        /// Both coils off until the operator opens the transport lock.
        TransportLock = 7, "transport-lock";
        /// Down with the lever at its bottom stop: both coils off, and no position of the hitch is a fault.
        Floating = 8, "floating";
        /// Finding thresholds and ends, as long as the button is held.
        Teaching = 9, "teaching";
    }
}

/// What a step asks for and what it thinks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Outputs {
    /// Current of the lift coil, after the safety envelope.
    pub lift_current: MilliAmp,
    /// Current of the lowering coil, after the safety envelope.
    pub lower_current: MilliAmp,
    /// State.
    pub state: State,
    /// Fault, if there is one.
    pub fault: Option<Fault>,
    /// What tripped the safety envelope, if it is tripped.
    pub trip: Option<Trip>,
    /// Set point that is being worked on, inside the limits.
    pub target: MilliDegree,
    /// Estimated piston travel.
    pub travel: Micrometre,
    /// Estimated piston speed.
    pub speed: MicrometrePerSecond,
    /// Piston speed asked of the valves, positive is up.
    pub demanded_speed: MicrometrePerSecond,
    /// Flow asked of the valves, positive into the cylinder.
    pub demanded_flow: MicroLitrePerSecond,
    /// Pressure drop that the lowering map uses.
    pub drop: MilliBar,
    /// Share of the supply for the lift coil.
    pub lift_duty: Duty,
    /// Share of the supply for the lowering coil.
    pub lower_duty: Duty,
    /// What determines the set point; `None`: the lever, an implement or quick lift alone.
    pub reference: Option<Reason>,
    /// Lost sensor of draft, depth or slip control.
    pub trouble: Option<Trouble>,
    /// Draft without its noise, positive against the direction of travel; `None`: no pins, or they are lost.
    pub draft: Option<Newton>,
    /// The implement is in work; `None` if that is not known.
    pub in_work: Option<bool>,
    /// Time until the implement is in work, 0 in work; `None` if it is not on its way there.
    pub time_until_work: Option<Millisecond>,
}

/// Size of the image of [`Inputs`].
pub const INPUT_BYTES: usize = 4 + 4 * INPUT_FIELDS;
/// Numbers in it, behind the word that says which of them are there.
const INPUT_FIELDS: usize = 18;
/// Bit of the first word for a fault of the enable line.
const ENABLE_LINE_FAULT: u32 = 1 << 30;
/// Size of the image of [`Outputs`].
pub const OUTPUT_BYTES: usize = 44;

impl Inputs {
    /// The first word of the image: a bit for each field that is there, and the switches from bit 22 on.
    #[must_use]
    pub fn valid_and_switches(&self) -> u32 {
        let fields = self.fields();
        let valid = fields
            .iter()
            .rev()
            .fold(0, |bits, field| (bits << 1) | u32::from(field.is_some()));
        let line = if self.enable_line_fault {
            ENABLE_LINE_FAULT
        } else {
            0
        };
        valid | self.switches.to_bits() | line
    }

    /// The numbers in the order of the image.
    fn fields(&self) -> [Option<i32>; INPUT_FIELDS] {
        [
            self.lever.map(|value| value.0),
            self.jog.map(|value| value.0),
            self.rocker_angle.map(|value| value.0),
            self.cylinder_pressure.map(|value| value.0),
            self.pump_pressure.map(|value| value.0),
            self.oil_temperature.map(|value| value.0),
            self.supply.map(|value| value.0),
            self.upper_limit.map(|value| value.0),
            self.lowering_dial.map(|value| value.0),
            self.engine_speed.map(|value| value.0),
            self.lift_current.map(|value| value.0),
            self.lower_current.map(|value| value.0),
            self.step_time.map(|value| value.0),
            self.second_angle.map(|value| value.0),
            self.sensor_supply.map(|value| value.0),
            self.reference.map(|value| value.0),
            self.set_point.map(|value| value.0),
            self.clock_ratio.map(|value| value.0),
        ]
    }

    /// A word of validity bits (bit 0: lever, and on in the order of the fields) and switches (bit 24:
    /// transport lock, and on; bit 30: a fault of the enable line), then the values. The inputs of draft, depth and slip
    /// control are not in the image.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; INPUT_BYTES] {
        let mut writer = Writer::<INPUT_BYTES>::default();
        writer.put(self.valid_and_switches().to_le_bytes());
        self.fields()
            .into_iter()
            .for_each(|field| writer.put(field.unwrap_or(0).to_le_bytes()));
        writer.bytes()
    }

    /// The inputs of an image. Unknown validity bits are ignored.
    #[must_use]
    pub fn from_bytes(bytes: &[u8; INPUT_BYTES]) -> Self {
        let mut words = bytes
            .as_chunks::<4>()
            .0
            .iter()
            .map(|word| i32::from_le_bytes(*word));
        let first = words.next().unwrap_or(0).cast_unsigned();
        let mut valid = first;
        let mut field = || {
            let present = valid & 1 == 1;
            valid >>= 1;
            words.next().filter(|_| present)
        };
        Self {
            lever: field().map(MilliDegree),
            jog: field().map(MilliDegreePerSecond),
            rocker_angle: field().map(MilliDegree),
            cylinder_pressure: field().map(MilliBar),
            pump_pressure: field().map(MilliBar),
            oil_temperature: field().map(MilliCelsius),
            supply: field().map(MilliVolt),
            upper_limit: field().map(MilliDegree),
            lowering_dial: field().map(PerMille),
            engine_speed: field().map(RevolutionPerMinute),
            lift_current: field().map(MilliAmp),
            lower_current: field().map(MilliAmp),
            step_time: field().map(Microsecond),
            second_angle: field().map(MilliDegree),
            sensor_supply: field().map(MilliVolt),
            reference: field().map(PerMille),
            set_point: field().map(MilliDegree),
            clock_ratio: field().map(PerMille),
            switches: Switches::from_bits(first),
            enable_line_fault: first & ENABLE_LINE_FAULT != 0,
            ..Self::default()
        }
    }
}

impl Outputs {
    /// State, fault (0: none), trip (0: none) and reference with trouble (low and high half of a byte, 0: none), then the
    /// values in the order of the fields. Draft, in-work and the time until then are not in the image.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; OUTPUT_BYTES] {
        let mut writer = Writer::<OUTPUT_BYTES>::default();
        writer.put([
            self.state as u8,
            self.fault.map_or(0, |fault| fault as u8),
            self.trip.map_or(0, |trip| trip as u8),
            field::to_byte(self.reference, self.trouble),
        ]);
        let values = [
            self.lift_current.0,
            self.lower_current.0,
            self.target.0,
            self.travel.0,
            self.speed.0,
            self.demanded_speed.0,
            self.demanded_flow.0,
            self.drop.0,
            self.lift_duty.0,
            self.lower_duty.0,
        ];
        values
            .into_iter()
            .for_each(|value| writer.put(value.to_le_bytes()));
        writer.bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_survive_their_image() {
        let inputs = Inputs {
            lever: Some(MilliDegree(90_000)),
            rocker_angle: Some(MilliDegree(-1)),
            pump_pressure: Some(MilliBar(4_000)),
            step_time: Some(Microsecond(1_000)),
            switches: Switches {
                hold: true,
                ..Switches::default()
            },
            ..Inputs::default()
        };
        let bytes = inputs.to_bytes();
        assert_eq!(
            bytes[..4],
            [0b1_0101, 0b1_0000, 0, 0b10],
            "lever, angle, pump pressure and step time are valid; hold is on"
        );
        assert_eq!(Inputs::from_bytes(&bytes), inputs);
    }

    #[test]
    fn outputs_have_a_fixed_image() {
        let outputs = Outputs {
            lift_current: MilliAmp(0x0102),
            state: State::Lifting,
            drop: MilliBar(-1),
            ..Outputs::default()
        };
        let bytes = outputs.to_bytes();
        assert_eq!(bytes[..8], [2, 0, 0, 0, 2, 1, 0, 0]);
        assert_eq!(bytes[32..36], [255; 4]);
    }
}
