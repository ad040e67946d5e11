//! Remote control: an implement commands the hitch, as long as the operator lets it (ISO 11783-7).
//!
//! ```text
//!          the same value as reported, and permitted
//!  +------+ ----------------------------------------> +--------+
//!  | Idle |                                           | Active | --+ further commands
//!  +------+ <---------------------------------------- +--------+ <-+ of the same source
//!             all ones: released       reserved value: out of range
//!             silence: time-out        no longer permitted: operator override
//!             bad heartbeat: time-out
//! ```
//!
//! The reason why control was given back stays until the next one begins. A fault of the controller comes before it,
//! and after two seconds a lock too: an implement has to see that its commands went missing, not that the hitch has
//! been locked in consequence. Commands from anybody but the one that took control are not heard meanwhile.

use hitch_quantities::units::PerMille;

use super::hitch;
use super::hitch::{ExitCode, HitchCommand, HitchStatus, Limit, LimitStatus};
use super::time::since_ms;

/// Commands come every 100 ms; three that are missing end remote control.
pub const TIMEOUT_MS: u32 = 300;
/// "The same value" may differ by one bit of the message (0.4 %): the position trembles by that much between report
/// and command. The lever has to come closer than ten times that.
const SAME_VALUE: u8 = 1;

/// For so long the reason comes before a lock, ms: twenty reports.
const REASON_MS: u32 = 2_000;

/// What the application is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Remote {
    /// Nobody commands: lever and buttons have the hitch.
    #[default]
    Idle,
    /// An implement commands this position; 0 is lowest. The operator's limits still apply to it.
    Position(PerMille),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RemoteState {
    Idle {
        reason: ExitCode,
        since_ms: u32,
    },
    Active {
        source: u8,
        set_point: u8,
        heard_ms: u32,
    },
}

/// The machine.
#[derive(Clone, Debug)]
pub struct RemoteControl {
    state: RemoteState,
    /// The last one that was reported, raw.
    reported: u8,
}

impl Default for RemoteControl {
    fn default() -> Self {
        Self {
            state: RemoteState::Idle {
                reason: ExitCode::Clear,
                since_ms: 0,
            },
            reported: hitch::raw_position(None),
        }
    }
}

impl RemoteControl {
    /// A command was heard.
    pub fn command(&mut self, command: HitchCommand, source: u8, permitted: bool, now_ms: u32) {
        self.state = match self.state {
            RemoteState::Active { source: owner, .. } if owner != source => self.state,
            RemoteState::Active { .. } => match command {
                HitchCommand::Position(set_point) => RemoteState::Active {
                    source,
                    set_point,
                    heard_ms: now_ms,
                },
                HitchCommand::None => idle(ExitCode::Released, now_ms),
                HitchCommand::OutOfRange => idle(ExitCode::OutOfRange, now_ms),
            },
            RemoteState::Idle { .. } => match command {
                HitchCommand::Position(set_point) if permitted && self.is_reported(set_point) => {
                    RemoteState::Active {
                        source,
                        set_point,
                        heard_ms: now_ms,
                    }
                }
                HitchCommand::OutOfRange if permitted => idle(ExitCode::OutOfRange, now_ms),
                _ => self.state,
            },
        };
    }

    /// Lets time pass and takes in what the controller says of the hitch. `condemned`: the heartbeat of who has the
    /// hitch says that it doesn't think any more.
    pub fn update(&mut self, status: &HitchStatus, condemned: bool, now_ms: u32) {
        let RemoteState::Active { heard_ms, .. } = self.state else {
            return;
        };
        if !status.remote_permitted {
            let reason = match status.exit {
                ExitCode::Clear => ExitCode::OperatorOverride,
                other => other,
            };
            self.state = idle(reason, now_ms);
        } else if condemned || since_ms(heard_ms, now_ms) > TIMEOUT_MS {
            self.state = idle(ExitCode::Timeout, now_ms);
        }
    }

    /// Who has the hitch.
    #[must_use]
    pub const fn owner(&self) -> Option<u8> {
        match self.state {
            RemoteState::Active { source, .. } => Some(source),
            RemoteState::Idle { .. } => None,
        }
    }

    /// `raw` was put on the bus as the position.
    pub fn reported(&mut self, raw: u8) {
        self.reported = raw;
    }

    /// What is asked for.
    #[must_use]
    pub fn remote(&self) -> Remote {
        match self.state {
            RemoteState::Idle { .. } => Remote::Idle,
            RemoteState::Active { set_point, .. } => Remote::Position(hitch::position(set_point)),
        }
    }

    /// Limit status as it is to be reported.
    #[must_use]
    pub fn limit_status(&self, status: &HitchStatus) -> LimitStatus {
        match (status.limit, self.state) {
            (Limit::NonRecoverable, _) => LimitStatus::NonRecoverable,
            (_, RemoteState::Idle { .. }) => LimitStatus::OperatorLimited,
            (Limit::None, RemoteState::Active { .. }) => LimitStatus::NotLimited,
            (Limit::High, RemoteState::Active { .. }) => LimitStatus::LimitedHigh,
            (Limit::Low, RemoteState::Active { .. }) => LimitStatus::LimitedLow,
        }
    }

    /// Reason as it is to be reported.
    #[must_use]
    pub fn exit_code(&self, status: &HitchStatus, now_ms: u32) -> ExitCode {
        let RemoteState::Idle {
            reason,
            since_ms: since,
        } = self.state
        else {
            return status.exit;
        };
        let recent = reason != ExitCode::Clear && since_ms(since, now_ms) < REASON_MS;
        match status.exit {
            ExitCode::Clear => reason,
            ExitCode::LockedOut if recent => reason,
            other => other,
        }
    }

    /// A position that isn't known is reported as 254, which is further from any command than a bit.
    fn is_reported(&self, set_point: u8) -> bool {
        set_point.abs_diff(self.reported) <= SAME_VALUE
    }
}

const fn idle(reason: ExitCode, now_ms: u32) -> RemoteState {
    RemoteState::Idle {
        reason,
        since_ms: now_ms,
    }
}
