//! Operating modes and what leads from one to the other.
//!
//! ```text
//!             power-up, reset
//!                   |
//!                   v    lever moved through the hitch
//!   healthy for  +--------+ ------------------------> +----------+  hold   +------+
//!   healthy_time | Locked |                           | Position | ------> | Hold |
//!   +----------> +--------+ <---+                     +----------+         +------+
//!   |               |  ^        | jog released         |     |                |
//! +-------+         |  |  jog   +-----+        jog     |     |   hold off: Locked
//! | Fault |         +--|------> | Jog | <--------------+     |
//! +-------+            |        +-----+                      |
//!   ^                  |           | fault                   | fault
//!   +------------------|-----------+-------------------------+
//!          engine stopped, or transport lock off
//!                      |
//!             +---------------+   transport lock on: from any mode but a fault
//!             | TransportLock | <----------------------------------------------
//!             +---------------+
//! ```
//!
//! With the service switch on, the button outside teaches a locked machine instead of moving it; letting go, or
//! switching the switch off, locks.
//!
//! A jog button outside the cab works while the lever is locked (it is held by a hand that sees the
//! hitch) and leaves the lever locked. A fault wins over everything from any mode.

use super::design_parameters::LockParameters;
use super::lock::StartLock;
use super::signals::Switches;
use super::units::Millisecond;

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

/// The operating mode.
#[derive(Clone, Copy, Debug)]
pub enum Mode {
    /// Waiting for the lever to pick the hitch up.
    Locked(StartLock),
    /// The hitch follows the lever.
    Position,
    /// The hitch moves while a button is held.
    Jog,
    /// The hitch stays where it is; the lever has no say.
    Hold,
    /// The machine is being taught.
    Teach,
    /// The operator has locked the hitch for the road.
    TransportLock,
    /// Both coils off; `healthy_for` counts towards the lock.
    Fault {
        /// What is wrong, or was.
        fault: Fault,
        /// For how long nothing has been wrong.
        healthy_for: Millisecond,
    },
}

impl Default for Mode {
    fn default() -> Self {
        Self::locked()
    }
}

impl Mode {
    /// The lock, freshly shut.
    #[must_use]
    pub fn locked() -> Self {
        Self::Locked(StartLock::default())
    }

    /// A fault was found: from any mode, and again while it lasts.
    #[must_use]
    pub fn failed(fault: Fault) -> Self {
        Self::Fault {
            fault,
            healthy_for: Millisecond::ZERO,
        }
    }

    /// A step without a fault.
    #[must_use]
    pub fn healthy(self, parameters: &LockParameters) -> Self {
        match self {
            Self::Fault { healthy_for, .. } if healthy_for >= parameters.healthy_time => {
                Self::locked()
            }
            Self::Fault { fault, healthy_for } => Self::Fault {
                fault,
                healthy_for: healthy_for.next(),
            },
            other => other,
        }
    }

    /// A step with or without a jog request; `teach`: it is a request to teach.
    #[must_use]
    pub fn jogged(self, requested: bool, teach: bool) -> Self {
        match (self, requested) {
            (Self::Locked(_), true) if teach => Self::Teach,
            (Self::Locked(_) | Self::Position | Self::Hold, true) => Self::Jog,
            (Self::Jog | Self::Teach, false) => Self::locked(),
            (other, _) => other,
        }
    }

    /// A step with the operator's switches, and with an engine that permits use or doesn't.
    #[must_use]
    pub fn switched(self, switches: Switches, engine_permits: bool) -> Self {
        match self {
            Self::Fault { .. } => self,
            _ if switches.transport_lock => Self::TransportLock,
            Self::TransportLock => Self::locked(),
            _ if !engine_permits => Self::locked(),
            Self::Teach if !switches.teach => Self::locked(),
            Self::Position if switches.hold => Self::Hold,
            Self::Hold if !switches.hold => Self::locked(),
            other => other,
        }
    }

    /// True where no coil may be on, whatever was going on before.
    #[must_use]
    pub const fn is_still(&self) -> bool {
        matches!(
            self,
            Self::Locked(_) | Self::TransportLock | Self::Fault { .. }
        )
    }

    /// The fault, if the mode is one.
    #[must_use]
    pub fn fault(&self) -> Option<Fault> {
        match self {
            Self::Fault { fault, .. } => Some(*fault),
            _ => None,
        }
    }
}
