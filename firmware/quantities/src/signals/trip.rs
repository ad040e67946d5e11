//! The rows of the safety envelope's table: what can trip it, and what that is called.

use super::fault::Fault;
use crate::codes;

/// Number of rows.
pub const ROWS: usize = Trip::ALL.len();

codes! {
    /// The reason for a trip of the envelope. Links and traces carry its code; the codes have the order of the table.
    Trip: u8 {
        /// No fresh command.
        Stale = 1;
        /// Both coils were asked for.
        BothCoils = 2;
        /// A step began too late or too early.
        Overrun = 3;
        /// The supply voltage is outside its limits.
        Supply = 4;
        /// The lever signal is missing or out of range.
        Lever = 5;
        /// The angle signal is missing or out of range.
        AngleMissing = 6;
        /// The angle signal jumps further than a hitch can move.
        AngleJumps = 7;
        /// The angle signal stands still to the last bit although the coil's current must have moved the hitch.
        AngleFrozen = 8;
        /// The angle signal is far noisier than its sensor.
        AngleNoisy = 9;
        /// The angle signal shows less travel than the coil's current must have caused.
        NotFollowing = 10;
        /// The hitch moves against the energised coil: coils or sensor are swapped.
        Against = 11;
        /// A coil has less current than it should: its wire is broken.
        CoilOpen = 12;
        /// A coil has more current than it should: it is shorted.
        CoilShort = 13;
        /// A coil has current although it is off: its driver is stuck.
        CoilStuck = 14;
        /// The converters' reference is off: currents and voltages can't be trusted.
        Reference = 15;
        /// The supply of the sensors is outside its limits.
        SensorSupply = 16;
        /// The tracks of the angle sensor disagree, or one of them is missing.
        AngleTracks = 17;
        /// The main clock has another rate than at the start.
        Clock = 18;
        /// The enable line of the coils' drivers: its read-back differs from its command.
        EnableLine = 19;
        /// The calibration in use no longer has its checksum: memory has lost a bit.
        Memory = 20;
        /// A current drives the hitch beyond a limit of its travel, or lowers it with the dial shut.
        BeyondLimit = 21;
        /// A current on the set point of an implement to which the operator has not consented.
        NoConsent = 22;
        /// A current of ride damping beyond its travel band, without its ground speed, or with the operator at the controls.
        Ride = 23;
    }
}

impl Trip {
    /// True if only a restart clears it: the driver has to be tested, or the calibration read from flash, before it is
    /// trusted again.
    #[must_use]
    pub const fn is_final(self) -> bool {
        matches!(
            self,
            Self::CoilShort | Self::CoilStuck | Self::EnableLine | Self::Memory
        )
    }

    /// The fault that the controller reports for it.
    #[must_use]
    pub const fn fault(self) -> Fault {
        match self {
            Self::Lever => Fault::Lever,
            Self::AngleMissing
            | Self::AngleJumps
            | Self::AngleFrozen
            | Self::AngleNoisy
            | Self::AngleTracks => Fault::Angle,
            Self::NotFollowing => Fault::NotFollowing,
            Self::Stale
            | Self::BothCoils
            | Self::Against
            | Self::BeyondLimit
            | Self::NoConsent
            | Self::Ride => Fault::Envelope,
            Self::Overrun | Self::Clock => Fault::Overrun,
            Self::Reference => Fault::Reference,
            Self::SensorSupply => Fault::SensorSupply,
            Self::EnableLine => Fault::EnableLine,
            Self::Memory => Fault::Memory,
            Self::Supply => Fault::Supply,
            Self::CoilOpen | Self::CoilShort | Self::CoilStuck => Fault::Coil,
        }
    }
}
