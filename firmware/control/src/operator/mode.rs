//! Operating modes and their transitions.
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
//! With the service switch on, the external button teaches a locked machine instead of moving it. Release of the button
//! or of the switch locks.
//!
//! The external button works while the lever is locked, because its operator sees the hitch, and leaves the lever
//! locked. A fault has priority in any mode.

use hitch_quantities::calibration::design_parameters::LockParameters;
use hitch_quantities::units::Millisecond;
use hitch_quantities::{Fault, Switches};

use super::lock::StartLock;

/// The operating mode.
#[derive(Clone, Copy, Debug)]
pub enum Mode {
    /// Waits for the lever to pass the position of the hitch.
    Locked(StartLock),
    /// The hitch follows the lever.
    Position,
    /// The hitch moves while a button is held.
    Jog,
    /// The hitch remains in place; the lever has no effect.
    Hold,
    /// Teaching is active.
    Teach,
    /// The operator has locked the hitch for the road.
    TransportLock,
    /// Both coils off; `healthy_for` counts towards the lock.
    Fault {
        /// The present or last fault.
        fault: Fault,
        /// Time without a fault.
        healthy_for: Millisecond,
    },
}

impl Default for Mode {
    fn default() -> Self {
        Self::locked()
    }
}

impl Mode {
    /// The lock in its initial state.
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

    /// A step with or without a jog request; `teach`: the request is for teaching.
    #[must_use]
    pub fn jogged(self, requested: bool, teach: bool) -> Self {
        match (self, requested) {
            (Self::Locked(_), true) if teach => Self::Teach,
            (Self::Locked(_) | Self::Position | Self::Hold, true) => Self::Jog,
            (Self::Jog | Self::Teach, false) => Self::locked(),
            (other, _) => other,
        }
    }

    /// A step with the switches of the operator, and with the permission of the engine monitor.
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

    /// True if both coils have to be off, whatever was active before.
    #[must_use]
    pub const fn is_still(&self) -> bool {
        matches!(
            self,
            Self::Locked(_) | Self::Hold | Self::TransportLock | Self::Fault { .. }
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
