//! Remote control: an implement commands the hitch, once the operator has consented (ISO 11783-7; the times and reasons
//! are those of Tractor Implement Management).
//!
//! ```text
//!          an implement commands the reported position       the operator consents within 10 s
//!  +------+ --------------------------------------> +-----------+ -----------> +-----------+
//!  | Idle |                                         | Requested |              | Consented |
//!  +------+ <-------------------------------------- +-----------+              +-----------+
//!     ^      each end has its reason, see below                                      |
//!     |                        +--------+   the reported position again, within 1.5 s
//!     +----------------------- | Active | <------------------------------------------+
//!                              +--------+
//! ```
//!
//! The implement has a claimed address and the NAME of an implement ([`Name::is_implement`]). Consent is an edge: it
//! counts for the request that is under way, and for no later one.
//!
//! | what ends it, in any state | reason |
//! |---|---|
//! | lever moved, button pressed, hold | operator override |
//! | a lock or a fault | its own reason |
//! | all ones | released |
//! | a reserved value; of a request, a position outside `remote.lowest` to `remote.highest` | out of range |
//! | 300 ms without a command, a bad heartbeat, consent that is not used within 1.5 s | time-out |
//! | no consent within 10 s | no operator |
//! | ground speed above `remote.ground_speed` | speed too high |
//! | own address lost; another NAME on the sender's address, or its NAME on another one; two set points within a period | error |
//! | remote control isn't offered (`remote.consent`) | not calibrated |
//!
//! The reason stays until the next request begins. A fault of the controller comes before it, and after two seconds a
//! lock too: an implement has to see that its commands went missing, not that the hitch has been locked in consequence.
//! A sender whose remote control has ended has to pause, or to give control back, before it can request it again.
//! Commands from anybody but the sender are not heard meanwhile.

use hitch_quantities::calibration::design_parameters::RemoteParameters;
use hitch_quantities::units::PerMille;

use super::hitch;
use super::hitch::{ExitCode, HitchCommand, HitchStatus, Limit, LimitStatus};
use super::name::Name;
use super::time::since_ms;

/// Commands come every 100 ms; three that are missing end remote control.
pub const TIMEOUT_MS: u32 = 300;
/// Time for the operator's consent, ms.
pub const CONSENT_MS: u32 = 10_000;
/// Time for the implement to command the reported position after the consent, ms: the hitch may still be settling.
pub const TRANSFER_MS: u32 = 1_500;
/// Two different set points closer than this come from two senders, ms: of two that send every 100 ms under one
/// address, one follows the other within 50 ms; the rest is their jitter.
const CONTENTION_MS: u32 = 60;
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

/// The implement that asks for the hitch or has it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Sender {
    source: u8,
    name: Name,
    /// Its last command, raw.
    set_point: u8,
    heard_ms: u32,
}

/// A sender whose remote control has ended and that still commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Spent {
    source: u8,
    heard_ms: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RemoteState {
    Idle {
        reason: ExitCode,
        since_ms: u32,
        spent: Option<Spent>,
    },
    Requested {
        sender: Sender,
        since_ms: u32,
    },
    Consented {
        sender: Sender,
        since_ms: u32,
    },
    Active {
        sender: Sender,
    },
}

/// What happens besides commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Surroundings {
    /// The heartbeat of the sender says that it doesn't think any more.
    pub condemned: bool,
    /// The ground speed is above its limit.
    pub too_fast: bool,
    /// The node has an address of its own.
    pub has_address: bool,
}

/// The machine.
#[derive(Clone, Debug)]
pub struct RemoteControl {
    state: RemoteState,
    /// The last one that was reported, raw.
    reported: u8,
    parameters: RemoteParameters,
}

impl Default for RemoteControl {
    fn default() -> Self {
        Self {
            state: idle(ExitCode::Clear, 0),
            reported: hitch::raw_position(None),
            parameters: RemoteParameters::NOMINAL,
        }
    }
}

impl RemoteControl {
    /// Takes the bounds of remote control.
    pub fn set_parameters(&mut self, parameters: RemoteParameters) {
        self.parameters = parameters;
    }

    /// The bounds of remote control.
    #[must_use]
    pub const fn parameters(&self) -> &RemoteParameters {
        &self.parameters
    }

    /// Whether an implement may ask for the hitch at all.
    #[must_use]
    pub fn is_offered(&self) -> bool {
        self.parameters.consent.0 != 0
    }

    /// A command was heard. `name`: that of the sender, if it is an implement with a claimed address. `permitted`:
    /// nothing speaks against a request.
    pub fn command(
        &mut self,
        command: HitchCommand,
        source: u8,
        name: Option<Name>,
        permitted: bool,
        now_ms: u32,
    ) {
        match self.sender() {
            Some(sender) if sender.source == source => self.proceed(sender, command, now_ms),
            Some(_) => {}
            None => self.request(command, source, name.filter(|_| permitted), now_ms),
        }
    }

    /// A command while nobody has the hitch.
    fn request(&mut self, command: HitchCommand, source: u8, name: Option<Name>, now_ms: u32) {
        if self.is_spent(source, command, now_ms) {
            return;
        }
        let Some(name) = name else {
            return;
        };
        match command {
            HitchCommand::Position(set_point) if self.is_reported(set_point) => {
                let sender = Sender {
                    source,
                    name,
                    set_point,
                    heard_ms: now_ms,
                };
                if !self.is_offered() {
                    self.state = idle(ExitCode::NotCalibrated, now_ms);
                } else if !self.is_in_range(set_point) {
                    self.state = idle(ExitCode::OutOfRange, now_ms);
                } else {
                    self.state = RemoteState::Requested {
                        sender,
                        since_ms: now_ms,
                    };
                }
            }
            HitchCommand::OutOfRange => self.state = idle(ExitCode::OutOfRange, now_ms),
            HitchCommand::Position(_) | HitchCommand::None => {}
        }
    }

    /// The next command of the sender.
    fn proceed(&mut self, sender: Sender, command: HitchCommand, now_ms: u32) {
        let set_point = match command {
            HitchCommand::Position(set_point) => set_point,
            HitchCommand::None => return self.state = idle(ExitCode::Released, now_ms),
            HitchCommand::OutOfRange => return self.end(ExitCode::OutOfRange, now_ms),
        };
        let is_soon = since_ms(sender.heard_ms, now_ms) < CONTENTION_MS;
        if is_soon && set_point != sender.set_point {
            return self.end(ExitCode::Error, now_ms);
        }
        let sender = Sender {
            set_point,
            heard_ms: now_ms,
            ..sender
        };
        self.state = match self.state {
            RemoteState::Consented { .. } if self.is_reported(set_point) => {
                RemoteState::Active { sender }
            }
            RemoteState::Requested { since_ms, .. } => RemoteState::Requested { sender, since_ms },
            RemoteState::Consented { since_ms, .. } => RemoteState::Consented { sender, since_ms },
            RemoteState::Active { .. } => RemoteState::Active { sender },
            RemoteState::Idle { .. } => self.state,
        };
    }

    /// A node has claimed `address`, or none.
    pub fn claimed(&mut self, address: u8, name: Name, now_ms: u32) {
        let contends = self
            .sender()
            .is_some_and(|sender| (sender.source == address) != (sender.name == name));
        if contends {
            self.end(ExitCode::Error, now_ms);
        }
    }

    /// Lets time pass and takes in what the controller says of the hitch.
    pub fn update(&mut self, status: &HitchStatus, around: Surroundings, now_ms: u32) {
        if let RemoteState::Idle { spent, .. } = &mut self.state {
            *spent = spent.filter(|spent| since_ms(spent.heard_ms, now_ms) <= TIMEOUT_MS);
        } else if let Some(reason) = self.reason_to_end(status, around, now_ms) {
            self.end(reason, now_ms);
        } else if let RemoteState::Requested { sender, .. } = self.state
            && status.consents
        {
            self.state = RemoteState::Consented {
                sender,
                since_ms: now_ms,
            };
        }
    }

    fn reason_to_end(
        &self,
        status: &HitchStatus,
        around: Surroundings,
        now_ms: u32,
    ) -> Option<ExitCode> {
        let sender = self.sender()?;
        if !status.remote_permitted {
            return Some(match status.exit {
                ExitCode::Clear => ExitCode::OperatorOverride,
                other => other,
            });
        }
        if !around.has_address {
            return Some(ExitCode::Error);
        }
        if !self.is_offered() {
            return Some(ExitCode::NotCalibrated);
        }
        if around.too_fast {
            return Some(ExitCode::SpeedTooHigh);
        }
        if around.condemned || since_ms(sender.heard_ms, now_ms) > TIMEOUT_MS {
            return Some(ExitCode::Timeout);
        }
        match self.state {
            RemoteState::Requested {
                since_ms: since, ..
            } => (since_ms(since, now_ms) >= CONSENT_MS).then_some(ExitCode::NoOperator),
            RemoteState::Consented {
                since_ms: since, ..
            } => (since_ms(since, now_ms) >= TRANSFER_MS).then_some(ExitCode::Timeout),
            RemoteState::Idle { .. } | RemoteState::Active { .. } => None,
        }
    }

    /// Ends what is under way; its sender has to pause before it can ask anew.
    fn end(&mut self, reason: ExitCode, now_ms: u32) {
        self.state = RemoteState::Idle {
            reason,
            since_ms: now_ms,
            spent: self.sender().map(|sender| Spent {
                source: sender.source,
                heard_ms: sender.heard_ms,
            }),
        };
    }

    /// Whether a command comes from a sender that has yet to pause.
    fn is_spent(&mut self, source: u8, command: HitchCommand, now_ms: u32) -> bool {
        let RemoteState::Idle { spent, .. } = &mut self.state else {
            return false;
        };
        let is_same = spent.is_some_and(|spent| spent.source == source);
        if is_same {
            *spent = (command != HitchCommand::None).then_some(Spent {
                source,
                heard_ms: now_ms,
            });
        }
        is_same
    }

    /// Who asks for the hitch or has it.
    const fn sender(&self) -> Option<Sender> {
        match self.state {
            RemoteState::Requested { sender, .. }
            | RemoteState::Consented { sender, .. }
            | RemoteState::Active { sender } => Some(sender),
            RemoteState::Idle { .. } => None,
        }
    }

    /// The address of who asks for the hitch or has it.
    #[must_use]
    pub fn owner(&self) -> Option<u8> {
        self.sender().map(|sender| sender.source)
    }

    /// Number of the state: 0 idle, 1 requested, 2 consented, 3 active.
    #[must_use]
    pub const fn state_code(&self) -> u8 {
        match self.state {
            RemoteState::Idle { .. } => 0,
            RemoteState::Requested { .. } => 1,
            RemoteState::Consented { .. } => 2,
            RemoteState::Active { .. } => 3,
        }
    }

    /// `raw` was put on the bus as the position.
    pub fn reported(&mut self, raw: u8) {
        self.reported = raw;
    }

    /// The position that was put on the bus last, raw.
    #[must_use]
    pub const fn last_reported(&self) -> u8 {
        self.reported
    }

    /// What is asked for, inside the bounds.
    #[must_use]
    pub fn remote(&self) -> Remote {
        match self.state {
            RemoteState::Active { sender } => {
                let (lowest, highest) = (self.parameters.lowest, self.parameters.highest);
                Remote::Position(hitch::position(sender.set_point).limited(lowest, highest))
            }
            _ => Remote::Idle,
        }
    }

    /// Limit status as it is to be reported.
    #[must_use]
    pub fn limit_status(&self, status: &HitchStatus) -> LimitStatus {
        let RemoteState::Active { sender } = self.state else {
            return match status.limit {
                Limit::NonRecoverable => LimitStatus::NonRecoverable,
                _ => LimitStatus::OperatorLimited,
            };
        };
        let asked = hitch::position(sender.set_point);
        match status.limit {
            Limit::NonRecoverable => LimitStatus::NonRecoverable,
            _ if asked > self.parameters.highest => LimitStatus::LimitedHigh,
            _ if asked < self.parameters.lowest => LimitStatus::LimitedLow,
            Limit::None => LimitStatus::NotLimited,
            Limit::High => LimitStatus::LimitedHigh,
            Limit::Low => LimitStatus::LimitedLow,
        }
    }

    /// Reason as it is to be reported. While the operator's consent is missing, it is that.
    #[must_use]
    pub fn exit_code(&self, status: &HitchStatus, now_ms: u32) -> ExitCode {
        let (reason, is_recent) = match self.state {
            RemoteState::Idle {
                reason,
                since_ms: since,
                ..
            } => (reason, since_ms(since, now_ms) < REASON_MS),
            RemoteState::Requested { .. } => (ExitCode::NoOperator, false),
            RemoteState::Consented { .. } | RemoteState::Active { .. } => (ExitCode::Clear, false),
        };
        let is_recent = is_recent && reason != ExitCode::Clear;
        match status.exit {
            ExitCode::Clear => reason,
            ExitCode::LockedOut if is_recent => reason,
            other => other,
        }
    }

    /// A position that isn't known is reported as 254, which is further from any command than a bit.
    fn is_reported(&self, set_point: u8) -> bool {
        set_point.abs_diff(self.reported) <= SAME_VALUE
    }

    /// Whether a position may be commanded.
    fn is_in_range(&self, set_point: u8) -> bool {
        let (lowest, highest) = (self.parameters.lowest, self.parameters.highest);
        let asked = hitch::position(set_point);
        asked.limited(lowest, highest) == asked
    }
}

const fn idle(reason: ExitCode, now_ms: u32) -> RemoteState {
    RemoteState::Idle {
        reason,
        since_ms: now_ms,
        spent: None,
    }
}
