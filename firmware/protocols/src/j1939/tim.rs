//! Tractor Implement Management (TIM, AEF 023 version 1) for the rear hitch.
//!
//! ```text
//!               client authenticated      assigned to it      operator consents      commands
//! +----------+    +-----------------+      +---------+          +---------+          +--------+
//! | NotReady | -> | ReadyToEnable   | ---> | Enabled | -------> | Pending | -------> | Active |
//! +----------+    +-----------------+      +---------+          +---------+          +--------+
//! Unavailable: no remote control, or locked       Fault: a fault of the hitch
//! ```
//!
//! Who authenticates a client (AEF 040) is not part of this module: it takes certificates, which this project does not
//! have. Without an [`Authority`] the node does not announce itself, so that it does not disturb the server of a
//! tractor, and refuses: an assignment with "not successful, client not certified", a command with "access denied", and
//! an attempt to authenticate with a negative acknowledgement. With one, the last two steps are those of
//! [`super::remote`]: the same consent, bounds, time-outs and reasons.
//!
//! The layouts are from public sources that name the clauses of AEF 023: robolibs/machbus (`src/isobus/tim`), and
//! AGRIForward/ROS2ISOBUS (`src/TIMClient`), which was run against another server. Motion commands (raise or lower until
//! stop) are not supported. The place of the exit code in the function status is not public; there are ones.

use heapless::Vec;

use super::automation::{Automation, Operation};
use super::heartbeat::{Heartbeat, Monitor};
use super::hitch::{ExitCode, HitchCommand, LimitStatus};
use super::id::{Id, Pgn};
use super::name::Name;
use super::request::Acknowledgement;
use super::scale;
use super::time::is_due;
use crate::can::Frame;

/// No client; as a NAME it would be no implement's.
const NOBODY: Name = Name(0);
/// The function "rear hitch".
const REAR_HITCH: u8 = 0x43;
// Message codes.
const ASSIGNMENT_STATUS: u8 = 0xF3;
const SUPPORT: u8 = 0xF4;
const ASSIGNMENT: u8 = 0xF5;
const VERSION: u8 = 0xF6;
const CLIENT_STATUS: u8 = 0xF9;
const SERVER_STATUS: u8 = 0xFA;
/// Implemented version, and the lowest one.
const IMPLEMENTED: u8 = 1;
/// Facilities of the hitch: motion not supported, position supported, the rest not defined.
const POSITION_ONLY: u8 = 0b0001_1111;
/// Functions of an assignment request that fits into a frame.
const MOST_FUNCTIONS: usize = 3;
/// Bit of the request type or status in the information of a function.
const TYPE_BIT: u8 = 5;
/// Types of a request for an assignment.
const RELEASE: u8 = 0;
const ASSIGN: u8 = 1;
const DO_NOT_CARE: u8 = 7;
/// Status and reason of an assignment.
const NOT_ASSIGNED: u8 = 0;
const ASSIGNED: u8 = 1 << TYPE_BIT;
const NOT_SUCCESSFUL: u8 = 5 << TYPE_BIT;
const FUNCTION_NOT_SUPPORTED: u8 = NOT_SUCCESSFUL | 1;
const FUNCTION_NOT_AVAILABLE: u8 = NOT_SUCCESSFUL | 2;
const UNKNOWN_REQUEST: u8 = NOT_SUCCESSFUL | 3;
const ERROR_IN_REQUEST: u8 = NOT_SUCCESSFUL | 4;
const CLIENT_NOT_CERTIFIED: u8 = NOT_SUCCESSFUL | 5;
/// Type of a function status, in the upper half of its second byte; that of a request is 0.
const FUNCTION_STATUS: u8 = 0x10;
/// Largest value that is a position, 0.01 % a bit.
const LARGEST_POSITION: u16 = 10_000;
/// Bits of a position per bit of the hitch command, which has 0.4 %.
const PER_COMMAND_BIT: u16 = 40;
/// Bits of a position per thousandth.
const PER_MILLE: u16 = 10;
/// Released control, requesting an action of the operator.
const RELEASED: u16 = 0xFBFD;
/// Ready to control.
const READY: u16 = 0xFBFF;
/// Priority of the server status.
const STATUS_PRIORITY: u8 = 4;
/// Priority of the other messages.
const PRIORITY: u8 = 6;
/// Replies that wait; more are dropped, and their clients repeat the request.
const MOST_REPLIES: usize = 2;
/// Interval between replies, ms; it bounds the bus load.
const SPACING_MS: u32 = 5;

/// What a maker with certificates adds; nothing by default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Authority {
    /// State of the tractor, if the node is its lead server; otherwise it does not announce itself.
    pub operation: Option<Operation>,
    /// NAME of the client that has been authenticated.
    pub client: Option<Name>,
}

/// What remote control says of the hitch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct View {
    /// Reason of the controller why it cannot be commanded.
    pub exit: ExitCode,
    /// Whether remote control is offered.
    pub is_offered: bool,
    /// State of remote control if the client has it, otherwise 0: 0 idle, 1 requested, 2 consented, 3 active.
    pub stage: u8,
    /// Limit status.
    pub limit: LimitStatus,
    /// Position, thousandths.
    pub position: Option<u16>,
    /// Position as it was reported, raw.
    pub reported: u8,
}

impl Default for View {
    fn default() -> Self {
        Self {
            exit: ExitCode::NotAvailable,
            is_offered: false,
            stage: 0,
            limit: LimitStatus::NotAvailable,
            position: None,
            reported: u8::MAX,
        }
    }
}

/// What the node sends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Said {
    /// A frame.
    Frame(Frame),
    /// A message to all that is longer than a frame.
    Message(Vec<u8, 13>),
}

/// A reply that waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Reply {
    Version,
    Support,
    AssignmentStatus,
    /// Number of functions, and each with its result.
    Assignment(u8, [u8; 6]),
    Function {
        counter: u8,
    },
    Refused {
        control: Acknowledgement,
        authentication: bool,
        code: u8,
        to: u8,
    },
}

/// The server.
#[derive(Clone, Debug)]
pub struct Tim {
    operation: Option<Operation>,
    /// The authenticated client, or [`NOBODY`].
    client: Name,
    view: View,
    /// The authenticated client has the hitch.
    is_assigned: bool,
    /// Its heartbeat.
    monitor: Option<Monitor>,
    heartbeat: Heartbeat,
    /// The oldest first.
    replies: [Option<Reply>; MOST_REPLIES],
    replied_ms: Option<u32>,
}

impl Default for Tim {
    fn default() -> Self {
        Self {
            operation: None,
            client: NOBODY,
            view: View::default(),
            is_assigned: false,
            monitor: None,
            heartbeat: Heartbeat::default(),
            replies: [None; MOST_REPLIES],
            replied_ms: None,
        }
    }
}

impl Tim {
    /// Takes what a maker adds.
    pub fn set_authority(&mut self, authority: Authority) {
        let client = authority.client.unwrap_or(NOBODY);
        if client != self.client {
            self.is_assigned = false;
            self.monitor = None;
        }
        if authority.operation.is_none() {
            self.heartbeat = Heartbeat::default();
        }
        (self.operation, self.client) = (authority.operation, client);
    }

    /// The NAME of the authenticated client.
    #[must_use]
    pub fn client(&self) -> Option<Name> {
        Some(self.client).filter(|&client| client != NOBODY)
    }

    /// Lets time pass and takes in the state of the hitch. A client without a valid heartbeat loses the hitch.
    pub fn update(&mut self, view: View, now_ms: u32) {
        self.view = view;
        self.is_assigned &= self.is_alive(now_ms);
    }

    /// Whether the heartbeat of the client is valid.
    fn is_alive(&self, now_ms: u32) -> bool {
        self.monitor.is_some_and(|monitor| monitor.is_alive(now_ms))
    }

    /// Automation status of the rear hitch.
    #[must_use]
    pub fn automation(&self) -> Automation {
        match (self.view.exit, self.view.limit) {
            (ExitCode::ControlFault | ExitCode::FunctionFault | ExitCode::Error, _) => {
                return Automation::Fault;
            }
            (_, LimitStatus::NonRecoverable) => return Automation::Fault,
            (ExitCode::Clear, _) if self.view.is_offered => {}
            _ => return Automation::Unavailable,
        }
        match (self.client(), self.view.stage, self.view.limit) {
            (None, _, _) => Automation::NotReady,
            _ if !self.is_assigned => Automation::ReadyToEnable,
            (_, 2, _) => Automation::Pending,
            (_, 3, LimitStatus::LimitedHigh) => Automation::ActiveLimitedHigh,
            (_, 3, LimitStatus::LimitedLow) => Automation::ActiveLimitedLow,
            (_, 3, _) => Automation::Active,
            _ => Automation::Enabled,
        }
    }

    /// A message of TIM or of its authentication to this node. Returns what the client that has the hitch asks of it.
    pub fn receive(
        &mut self,
        id: &Id,
        bytes: &[u8; 8],
        name: Option<Name>,
        now_ms: u32,
    ) -> Option<HitchCommand> {
        let is_client = name.is_some() && name == self.client();
        let [code, second, _, _, low, high, _, _] = *bytes;
        let refused = |control| Reply::Refused {
            control,
            authentication: id.pgn == Pgn::AUTHENTICATION_CLIENT,
            code,
            to: id.source,
        };
        if id.pgn == Pgn::AUTHENTICATION_CLIENT {
            if self.operation.is_none() {
                self.reply(refused(Acknowledgement::Negative));
            }
            return None;
        }
        match code {
            VERSION => self.reply(Reply::Version),
            SUPPORT => self.reply(Reply::Support),
            ASSIGNMENT_STATUS => self.reply(Reply::AssignmentStatus),
            ASSIGNMENT => {
                let reply = self.assigned(bytes, is_client, now_ms);
                self.reply(reply);
            }
            CLIENT_STATUS if is_client => {
                self.monitor = Monitor::heard(self.monitor, id.source, second, now_ms);
            }
            CLIENT_STATUS => {}
            REAR_HITCH if second & 0xF0 == 0 => {
                if !is_client || !self.is_assigned {
                    self.reply(refused(Acknowledgement::AccessDenied));
                    return None;
                }
                self.reply(Reply::Function {
                    counter: second & 0x0F,
                });
                return self.command(u16::from_le_bytes([low, high]));
            }
            _ => self.reply(refused(Acknowledgement::Negative)),
        }
        None
    }

    /// The command of a value. "Ready" requests the hitch at its present position. It is ignored after the consent, when a
    /// position has to follow, and it is invalid while the client commands.
    fn command(&self, value: u16) -> Option<HitchCommand> {
        match (value, self.view.stage) {
            (0..=LARGEST_POSITION, _) => {
                let raw = value.saturating_add(PER_COMMAND_BIT / 2) / PER_COMMAND_BIT;
                Some(HitchCommand::Position(raw.to_le_bytes()[0]))
            }
            (RELEASED, _) => Some(HitchCommand::None),
            (READY, 0 | 1) => Some(HitchCommand::Position(self.view.reported)),
            (READY, 2) => None,
            _ => Some(HitchCommand::OutOfRange),
        }
    }

    /// The response to a request for assignments.
    fn assigned(&mut self, bytes: &[u8; 8], is_client: bool, now_ms: u32) -> Reply {
        let [_, count, patterns @ ..] = *bytes;
        let fits = (1..=MOST_FUNCTIONS).contains(&usize::from(count));
        let functions = if fits { count } else { 1 };
        let mut results = [0xFF; 6];
        let pairs = results.as_chunks_mut::<2>().0.iter_mut();
        let wanted = patterns.as_chunks::<2>().0.iter();
        for ([function, result], &[asked, information]) in
            pairs.zip(wanted).take(usize::from(functions))
        {
            *function = asked;
            *result = match (asked, information >> TYPE_BIT) {
                _ if !fits => ERROR_IN_REQUEST,
                (REAR_HITCH, kind) => self.assign(kind, is_client, now_ms),
                _ => FUNCTION_NOT_SUPPORTED,
            };
        }
        Reply::Assignment(functions, results)
    }

    fn assign(&mut self, kind: u8, is_client: bool, now_ms: u32) -> u8 {
        match kind {
            ASSIGN if !is_client => return CLIENT_NOT_CERTIFIED,
            ASSIGN => match self.automation() {
                Automation::Unavailable | Automation::Fault => return FUNCTION_NOT_AVAILABLE,
                _ if !self.is_alive(now_ms) => return FUNCTION_NOT_AVAILABLE,
                _ => self.is_assigned = true,
            },
            RELEASE if is_client => self.is_assigned = false,
            RELEASE | DO_NOT_CARE => {}
            _ => return UNKNOWN_REQUEST,
        }
        if is_client && self.is_assigned {
            ASSIGNED
        } else {
            NOT_ASSIGNED
        }
    }

    /// The next message that is due: the server status, or a reply. `has_room`: a longer message can be sent.
    pub fn poll(&mut self, source: u8, has_room: bool, now_ms: u32) -> Option<Said> {
        let status = self.operation.and_then(|operation| {
            self.heartbeat.asked();
            let number = self.heartbeat.poll(now_ms)?;
            Some(self.server_status(number, operation))
        });
        if let Some(bytes) = status {
            let id = Id::broadcast(Pgn::TIM_SERVER, STATUS_PRIORITY, source);
            return Some(Said::Frame(id.frame(bytes)));
        }
        let is_spaced = is_due(self.replied_ms, SPACING_MS, now_ms);
        let is_ready = |reply: &Reply| is_spaced && (has_room || *reply != Reply::AssignmentStatus);
        let [first, next] = self.replies;
        let reply = first.filter(is_ready)?;
        self.replies = [next, None];
        self.replied_ms = Some(now_ms);
        Some(self.said(reply, source))
    }

    fn server_status(&self, number: u8, operation: Operation) -> [u8; 8] {
        let automation = self.automation();
        let lead = u8::from(self.client().is_some());
        let system = if automation.is_active() { 5 } else { 1 };
        let server = automation.of_server();
        let state = (server << 4) | operation as u8;
        let [a, b] = [(lead << 4) | system, state];
        [SERVER_STATUS, number, a, b, 0xFF, 0xFF, 0xFF, 0xFF]
    }

    fn said(&self, reply: Reply, source: u8) -> Said {
        const NO: u8 = 0xFF;
        let bytes = match reply {
            Reply::Version => [VERSION, 0, IMPLEMENTED, IMPLEMENTED, NO, NO, NO, NO],
            Reply::Support => [SUPPORT, 1, REAR_HITCH, 1, POSITION_ONLY, NO, NO, NO],
            Reply::Assignment(count, [a, b, c, d, e, f]) => [ASSIGNMENT, count, a, b, c, d, e, f],
            Reply::AssignmentStatus => match self.client() {
                Some(name) if self.is_assigned => {
                    // Its length is that of the message, so that no check for room is left.
                    let [a, b, c, d, e, f, g, h] = name.to_bytes();
                    let [kind, code, count] = [ASSIGNMENT_STATUS, 0, 1];
                    let status = [kind, code, count, a, b, c, d, e, f, g, h, 1, REAR_HITCH];
                    return Said::Message(status.into_iter().collect());
                }
                _ => [ASSIGNMENT_STATUS, 1, REAR_HITCH, 0, NO, NO, NO, NO],
            },
            Reply::Function { counter } => {
                let position = self.view.position.map_or(scale::ERROR, |position| {
                    position.saturating_mul(PER_MILLE).min(LARGEST_POSITION)
                });
                let [low, high] = position.to_le_bytes();
                let state = 0xF0 | self.automation() as u8;
                let kind = FUNCTION_STATUS | counter;
                [REAR_HITCH, kind, state, NO, low, high, NO, NO]
            }
            Reply::Refused {
                control,
                authentication,
                code,
                to,
            } => {
                let group = if authentication {
                    Pgn::AUTHENTICATION_CLIENT
                } else {
                    Pgn::TIM_CLIENT
                };
                let [a, b, c] = group.to_bytes();
                let id = Id::broadcast(Pgn::ACKNOWLEDGEMENT, PRIORITY, source);
                return Said::Frame(id.to(to).frame([control as u8, code, NO, NO, to, a, b, c]));
            }
        };
        Said::Frame(Id::broadcast(Pgn::TIM_SERVER, PRIORITY, source).frame(bytes))
    }

    /// Queues a reply; one that is queued is not added twice.
    fn reply(&mut self, reply: Reply) {
        if !self.replies.contains(&Some(reply))
            && let Some(free) = self.replies.iter_mut().find(|reply| reply.is_none())
        {
            *free = Some(reply);
        }
    }

    /// What was begun under an address ends with it.
    pub fn reset(&mut self) {
        self.is_assigned = false;
        self.monitor = None;
        self.heartbeat = Heartbeat::default();
        self.replies = [None; MOST_REPLIES];
    }
}
