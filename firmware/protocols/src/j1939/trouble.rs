//! Trouble codes: a suspect parameter number (SPN) and a failure mode (FMI).
//!
//! SPNs are those of J1939 where defined, otherwise from the manufacturer range (from 520 192).
//! FMIs: 2 erratic, 3 voltage high, 4 voltage low, 5 current low or open, 6 current high or grounded,
//! 7 mechanical system doesn't respond, 8 abnormal frequency, 9 abnormal update rate, 10 abnormal rate of change, 12 bad unit,
//! 13 out of calibration, 14 special instructions, 31 condition exists.
//!
//! FMI 9 is for what did not come at its time, also a step of the controller, and 31 for a condition that no other FMI
//! describes. So it is with the bus, SPN 639: lost frames are 9; bus-off is 31, since neither the data (2, 19) nor this unit
//! (12) has to be bad if a wire is.

/// A diagnostic trouble code without its count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Code {
    /// Suspect parameter number, 19 bits.
    pub spn: u32,
    /// Failure mode identifier, 5 bits.
    pub fmi: u8,
}

/// Engine speed.
const ENGINE_SPEED: u32 = 190;
/// Battery potential.
const SUPPLY: u32 = 168;
/// Rear hitch position.
const POSITION: u32 = 1873;
/// Rear draft.
const DRAFT: u32 = 1879;
/// Ground-based machine speed.
const GROUND_SPEED: u32 = 1859;
/// Wheel-based machine speed.
const WHEEL_SPEED: u32 = 1862;
/// First manufacturer-specific number.
const OWN: u32 = 520_192;
const LEVER: u32 = OWN;
const LIFT_VALVE: u32 = OWN + 1;
const LOWERING_VALVE: u32 = OWN + 2;
const COILS: u32 = OWN + 3;
const HITCH: u32 = OWN + 4;
const CONTROLLER: u32 = OWN + 5;
const CALIBRATION: u32 = OWN + 6;
const CYLINDER_PRESSURE: u32 = OWN + 7;
const PUMP_PRESSURE: u32 = OWN + 8;
const REFERENCE: u32 = OWN + 9;
const ANGLE_TRACKS: u32 = OWN + 10;
const ENABLE_LINE: u32 = OWN + 11;
const REMOTE: u32 = OWN + 12;
const BUTTONS: u32 = OWN + 13;
const SAFETY_VALUES: u32 = OWN + 14;
const CRYSTAL: u32 = OWN + 18;
const IMAGE: u32 = OWN + 19;
/// Both speeds of slip control.
const SPEEDS: u32 = OWN + 20;
/// Ride damping.
const RIDE: u32 = OWN + 21;
/// External depth sensor.
const DEPTH: u32 = OWN + 22;
/// J1939 network 1, the primary vehicle network.
const NETWORK: u32 = 639;
/// Sensor supply voltage 1.
const SENSOR_SUPPLY: u32 = 3509;

macro_rules! troubles {
    ($($(#[$doc:meta])+ $name:ident = $spn:ident / $fmi:literal,)+) => {
        /// All faults that this unit can report.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u8)]
        pub enum Trouble {
            $($(#[$doc])+ $name,)+
        }

        impl Trouble {
            /// All of them, in the order of their bits.
            pub const ALL: &'static [Self] = &[$(Self::$name,)+];

            /// Its code.
            #[must_use]
            pub const fn code(self) -> Code {
                match self {
                    $(Self::$name => Code { spn: $spn, fmi: $fmi },)+
                }
            }
        }
    };
}

troubles! {
    /// Supply above its limit.
    SupplyHigh = SUPPLY / 3,
    /// Supply below its limit.
    SupplyLow = SUPPLY / 4,
    /// Lever: missing, out of range.
    LeverMissing = LEVER / 31,
    /// Lever: voltage too high.
    LeverHigh = LEVER / 3,
    /// Lever: voltage too low.
    LeverLow = LEVER / 4,
    /// Angle: missing, out of range.
    AngleMissing = POSITION / 31,
    /// Angle: voltage too high.
    AngleHigh = POSITION / 3,
    /// Angle: voltage too low.
    AngleLow = POSITION / 4,
    /// Angle: jumps.
    AngleJumps = POSITION / 10,
    /// Angle: frozen although the hitch moves.
    AngleFrozen = POSITION / 9,
    /// Angle: noisy.
    AngleNoisy = POSITION / 2,
    /// The hitch does not follow an open valve, or stalls.
    NotFollowing = HITCH / 7,
    /// The hitch sinks: lowering valve or check valve leaks.
    Sinking = HITCH / 31,
    /// The hitch moves against the energised coil: wires or sensor swapped.
    Against = HITCH / 14,
    /// Lift coil open.
    LiftCoilOpen = LIFT_VALVE / 5,
    /// Lift coil shorted, or its driver stuck.
    LiftCoilShort = LIFT_VALVE / 6,
    /// Lowering coil open.
    LoweringCoilOpen = LOWERING_VALVE / 5,
    /// Lowering coil shorted, or its driver stuck.
    LoweringCoilShort = LOWERING_VALVE / 6,
    /// A coil or driver that is not identified.
    Coils = COILS / 31,
    /// The controller was late.
    Overrun = CONTROLLER / 9,
    /// The controller made an invalid request.
    Controller = CONTROLLER / 12,
    /// No valid calibration was found: the factory calibration is in use.
    CalibrationLost = CALIBRATION / 13,
    /// One of the two stored calibrations is damaged.
    CalibrationCopyLost = CALIBRATION / 31,
    /// Cylinder pressure sensor out of range.
    CylinderPressure = CYLINDER_PRESSURE / 2,
    /// Pump pressure sensor out of range.
    PumpPressure = PUMP_PRESSURE / 2,
    /// The converters' reference is out of tolerance.
    Reference = REFERENCE / 13,
    /// Supply of the sensors above its limit.
    SensorSupplyHigh = SENSOR_SUPPLY / 3,
    /// Supply of the sensors below its limit.
    SensorSupplyLow = SENSOR_SUPPLY / 4,
    /// The tracks of the angle sensor disagree.
    AngleTracks = ANGLE_TRACKS / 2,
    /// The rate of the main clock is wrong.
    Clock = CONTROLLER / 8,
    /// The enable line of the coils' drivers: its read-back differs from its command.
    EnableLine = ENABLE_LINE / 12,
    /// The calibration in use has changed in memory.
    Memory = CALIBRATION / 12,
    /// A current drives the hitch beyond a limit of its travel, or lowers it with the dial shut.
    BeyondLimit = CONTROLLER / 31,
    /// The engine speed is no longer received, or was never although the calibration requires it.
    EngineSpeedLost = ENGINE_SPEED / 9,
    /// A current on the set point of an implement to which the operator has not consented.
    NoConsent = REMOTE / 31,
    /// Safety values were stored, and no block of them is good any more: the hitch is locked.
    SafetyValuesLost = SAFETY_VALUES / 12,
    /// Safety values differ from those that the firmware is shipped with.
    SafetyValuesDiffer = SAFETY_VALUES / 31,
    /// A contact of an external button has been closed since power-up, or for longer than a press.
    ButtonClosed = BUTTONS / 4,
    /// The two contacts of an external button contradict each other.
    ButtonContacts = BUTTONS / 2,
    /// At the start the crystal, or the watchdog's oscillator, was out of range of the internal oscillator: the hitch is locked.
    Crystal = CRYSTAL / 8,
    /// The image has no checksum: the hitch is locked unless the image is for debugging.
    ImageUnsealed = IMAGE / 31,
    /// The image is for debugging.
    ImageForDebugging = IMAGE / 14,
    /// The CAN controller has left the bus after too many errors; active for 5 s after it is back.
    BusOff = NETWORK / 31,
    /// Received frames were lost as a queue was full; active for 5 s after the last one.
    FramesLost = NETWORK / 9,
    /// A draft pin: missing, out of range.
    DraftPinMissing = DRAFT / 31,
    /// The draft pins disagree, or one is too noisy.
    DraftPins = DRAFT / 2,
    /// A draft pin stands still while the implement works.
    DraftPinFrozen = DRAFT / 9,
    /// The ground speed that slip guard or ride damping needs is not received.
    GroundSpeedLost = GROUND_SPEED / 9,
    /// The wheel speed that the slip guard needs is not received.
    WheelSpeedLost = WHEEL_SPEED / 9,
    /// One of the speeds of the slip guard stands still while the other one changes.
    SpeedFrozen = SPEEDS / 2,
    /// The external depth sensor: missing, out of range.
    DepthSensorMissing = DEPTH / 31,
    /// The external depth sensor stands still while the implement works.
    DepthSensorFrozen = DEPTH / 9,
    /// The external depth sensor is too noisy.
    DepthSensorNoisy = DEPTH / 2,
    /// A current of ride damping beyond its travel band, without its ground speed, or with the operator at the controls.
    Ride = RIDE / 31,
}

/// A set of troubles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Troubles(u64);

const _: () = assert!(Trouble::ALL.len() <= 64, "a set has 64 bits");

impl Troubles {
    /// None.
    pub const NONE: Self = Self(0);

    /// The set with one more element.
    pub const fn insert(&mut self, trouble: Trouble) {
        self.0 |= 1 << trouble as u64;
    }

    /// Whether the set contains it.
    #[must_use]
    pub const fn contains(self, trouble: Trouble) -> bool {
        self.0 & (1 << trouble as u64) != 0
    }

    /// Whether the set is empty.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Number of elements.
    #[must_use]
    pub const fn count(self) -> u32 {
        self.0.count_ones()
    }

    /// Union.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Difference.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Its elements, in the order of [`Trouble::ALL`].
    pub fn iter(self) -> impl Iterator<Item = Trouble> {
        Trouble::ALL
            .iter()
            .copied()
            .filter(move |&trouble| self.contains(trouble))
    }
}

impl From<Trouble> for Troubles {
    fn from(trouble: Trouble) -> Self {
        let mut set = Self::NONE;
        set.insert(trouble);
        set
    }
}
