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

use hitch_quantities::calibration::design_parameters::LockParameters;
use hitch_quantities::units::Millisecond;
use hitch_quantities::{Fault, Switches};

use super::lock::StartLock;

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
