//! What the controller reports when it refuses to move.

/// Why the controller refuses to move, with the code it has on links and in traces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// The lever signal is missing or out of range.
    Lever = 1,
    /// The angle signal is missing, out of range or jumps.
    Angle = 2,
    /// The hitch doesn't stay where it was put: the lowering spool or the check valve leaks.
    Sinking = 3,
    /// Flow is demanded and the hitch doesn't move: relief valve, obstacle, valve or angle sensor stuck.
    NotMoving = 4,
    /// The safety envelope tripped on a command or a movement that must not be.
    Envelope = 5,
    /// The hitch was moving and seems to have stopped: obstacle, or an angle sensor that no longer follows.
    NotFollowing = 6,
    /// A coil, its wire or its driver.
    Coil = 7,
    /// The supply voltage is outside its limits.
    Supply = 8,
    /// The controller isn't called in time, or its clock is off.
    Overrun = 9,
    /// The converters' reference is off.
    Reference = 10,
    /// The supply of the sensors is outside its limits.
    SensorSupply = 11,
    /// The enable line of the coils' drivers: its read-back differs from its command.
    EnableLine = 12,
    /// The calibration in use has changed in memory.
    Memory = 13,
}

impl Fault {
    /// All of them, in the order of their codes, which begin at 1.
    pub const ALL: [Self; 13] = [
        Self::Lever,
        Self::Angle,
        Self::Sinking,
        Self::NotMoving,
        Self::Envelope,
        Self::NotFollowing,
        Self::Coil,
        Self::Supply,
        Self::Overrun,
        Self::Reference,
        Self::SensorSupply,
        Self::EnableLine,
        Self::Memory,
    ];

    /// The fault with a code; 0 is none.
    #[must_use]
    pub fn from_code(code: u8) -> Option<Self> {
        Self::ALL.into_iter().find(|fault| *fault as u8 == code)
    }

    /// Name as it appears in text outputs.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Lever => "lever",
            Self::Angle => "angle",
            Self::Sinking => "sinking",
            Self::NotMoving => "not-moving",
            Self::Envelope => "envelope",
            Self::NotFollowing => "not-following",
            Self::Coil => "coil",
            Self::Supply => "supply",
            Self::Overrun => "overrun",
            Self::Reference => "reference",
            Self::SensorSupply => "sensor-supply",
            Self::EnableLine => "enable-line",
            Self::Memory => "memory",
        }
    }
}
