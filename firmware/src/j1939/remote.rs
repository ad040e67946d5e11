//! Remote control: an implement commands the hitch, as long as the operator lets it (ISO 11783-7).
//!
//! ```text
//!          the same value as reported, and permitted
//!  +------+ ----------------------------------------> +--------+
//!  | Idle |                                           | Active | --+ further commands
//!  +------+ <---------------------------------------- +--------+ <-+ of the same source
//!             all ones: released       reserved value: out of range
//!             silence: time-out        no longer permitted: operator override
//! ```
//!
//! The reason why control was given back stays until the next one begins. Commands from anybody but the one that
//! took control are not heard meanwhile.

use super::hitch::{self, ExitCode, HitchCommand, HitchStatus, Limit, LimitStatus};
use super::time::since_ms;
use crate::control::units::PerMille;

/// Commands come every 100 ms; three that are missing end remote control.
pub const TIMEOUT_MS: u32 = 300;
/// "The same value" may differ by one bit of the message (0.4 %): the position trembles by that much between report
/// and command. The lever has to come closer than ten times that.
const SAME_VALUE: u8 = 1;

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
enum State {
    Idle {
        reason: ExitCode,
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
    state: State,
    /// The last one that was reported, raw.
    reported: u8,
}

impl Default for RemoteControl {
    fn default() -> Self {
        Self {
            state: State::Idle {
                reason: ExitCode::Clear,
            },
            reported: hitch::raw_position(None),
        }
    }
}

impl RemoteControl {
    /// A command was heard.
    pub fn command(&mut self, command: HitchCommand, source: u8, permitted: bool, now_ms: u32) {
        self.state = match self.state {
            State::Active { source: owner, .. } if owner != source => self.state,
            State::Active { .. } => match command {
                HitchCommand::Position(set_point) => State::Active {
                    source,
                    set_point,
                    heard_ms: now_ms,
                },
                HitchCommand::None => idle(ExitCode::Released),
                HitchCommand::OutOfRange => idle(ExitCode::OutOfRange),
            },
            State::Idle { .. } => match command {
                HitchCommand::Position(set_point) if permitted && self.is_reported(set_point) => {
                    State::Active {
                        source,
                        set_point,
                        heard_ms: now_ms,
                    }
                }
                HitchCommand::OutOfRange if permitted => idle(ExitCode::OutOfRange),
                _ => self.state,
            },
        };
    }

    /// Lets time pass and takes in what the controller says of the hitch.
    pub fn update(&mut self, status: &HitchStatus, now_ms: u32) {
        let State::Active { heard_ms, .. } = self.state else {
            return;
        };
        if !status.remote_permitted {
            self.state = idle(ExitCode::OperatorOverride);
        } else if since_ms(heard_ms, now_ms) > TIMEOUT_MS {
            self.state = idle(ExitCode::Timeout);
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
            State::Idle { .. } => Remote::Idle,
            State::Active { set_point, .. } => Remote::Position(hitch::position(set_point)),
        }
    }

    /// Limit status as it is to be reported.
    #[must_use]
    pub fn limit_status(&self, status: &HitchStatus) -> LimitStatus {
        match (status.limit, self.state) {
            (Limit::NonRecoverable, _) => LimitStatus::NonRecoverable,
            (_, State::Idle { .. }) => LimitStatus::OperatorLimited,
            (Limit::None, State::Active { .. }) => LimitStatus::NotLimited,
            (Limit::High, State::Active { .. }) => LimitStatus::LimitedHigh,
            (Limit::Low, State::Active { .. }) => LimitStatus::LimitedLow,
        }
    }

    /// Reason as it is to be reported: the controller's own, else why the last one lost control.
    #[must_use]
    pub fn exit_code(&self, status: &HitchStatus) -> ExitCode {
        match self.state {
            _ if status.exit != ExitCode::Clear => status.exit,
            State::Idle { reason } => reason,
            State::Active { .. } => ExitCode::Clear,
        }
    }

    fn is_reported(&self, set_point: u8) -> bool {
        set_point.abs_diff(self.reported) <= SAME_VALUE && self.reported <= 250
    }
}

const fn idle(reason: ExitCode) -> State {
    State::Idle { reason }
}
