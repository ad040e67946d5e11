//! Hitch messages: rear hitch status and hitch commands (ISO 11783-7).
//!
//! A one-byte quantity is data up to 250; 251 to 253 are reserved, 254 says that the sender's signal is
//! bad, 255 that there is none. Unused bits are ones.

use hitch_quantities::codes;
use hitch_quantities::units::{Millisecond, Newton, PerMille};

use super::scale::{self, Scale};
use super::trouble::Troubles;

/// Largest raw value of a one-byte quantity that is data.
const LARGEST: u8 = 250;
/// Raw value: the signal is bad.
const ERROR: u8 = 254;
/// Raw value: not available; in a command, nothing is asked for.
const NOT_AVAILABLE: u8 = 255;
/// Positions have 0.4 % a bit.
const PER_MILLE_PER_BIT: i32 = 4;
/// Draft: 10 N a bit from -320 kN.
const DRAFT: Scale = Scale {
    offset: -320_000,
    per_bit: 10,
};
/// A time: 1 ms a bit.
const TIME: Scale = Scale {
    offset: 0,
    per_bit: 1,
};

/// What the controller tells the bus about the hitch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HitchStatus {
    /// Position, 0 is lowest; `None` if the sensor is bad.
    pub position: Option<PerMille>,
    /// In work, or not.
    pub in_work: InWork,
    /// Time until then; `None` if the implement is not on its way there.
    pub time_until_work: Option<Millisecond>,
    /// What limits the set point just now.
    pub limit: Limit,
    /// Why the hitch can't be commanded, or [`ExitCode::Clear`].
    pub exit: ExitCode,
    /// True while the hitch follows lever or implement and the operator does nothing else. Otherwise remote control
    /// ends, with the reason in `exit`, or as the operator's override.
    pub remote_permitted: bool,
    /// The operator consents to remote control in this step.
    pub consents: bool,
    /// The draft.
    pub draft: Draft,
    /// What is wrong.
    pub troubles: Troubles,
}

codes! {
    /// In-work indication (SPN 1877), 2 bits: the hitch is below or above an adjustable threshold.
    #[derive(Default)]
    InWork: u8 {
        /// Out of work.
        No = 0;
        /// In work.
        Yes = 1;
        /// The sensor is bad.
        Error = 2;
        /// There is no threshold.
        #[default]
        NotAvailable = 3;
    }
}

/// What is known of the draft: the force of the implement against the direction of travel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Draft {
    /// No draft pins.
    #[default]
    NotFitted,
    /// The pins are lost.
    Lost,
    /// The draft.
    Measured(Newton),
}

/// What limits the set point, as the controller sees it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Limit {
    /// Nothing.
    #[default]
    None,
    /// It is as high as it may be (or rises as fast as it may): only lower values act.
    High,
    /// It is as low as it may be (or falls as fast as it may): only higher values act.
    Low,
    /// A fault that only a restart clears.
    NonRecoverable,
}

codes! {
    /// Position limit status (SPN 5151), 3 bits.
    LimitStatus: u8 {
        /// The command acts.
        NotLimited = 0;
        /// The operator has control.
        OperatorLimited = 1;
        /// Only lower values act.
        LimitedHigh = 2;
        /// Only higher values act.
        LimitedLow = 3;
        /// 4 and 5.
        Reserved = 4;
        /// Fault that only a restart clears.
        NonRecoverable = 6;
        /// Not available.
        NotAvailable = 7;
    }
}

codes! {
    /// Exit or reason code (SPN 5819), 6 bits: why the hitch left remote control, or can't be in it.
    #[derive(Default)]
    ExitCode: u8 {
        /// No reason, all clear.
        #[default]
        Clear = 0;
        /// Required level of operator presence not detected.
        NoOperator = 1;
        /// The implement gave control back.
        Released = 2;
        /// The operator took control.
        OperatorOverride = 3;
        /// Operator control not in a valid position.
        ControlNotValid = 4;
        /// The commands stopped.
        Timeout = 5;
        /// A command was out of range.
        OutOfRange = 6;
        /// Not calibrated.
        NotCalibrated = 7;
        /// The operator control is faulty.
        ControlFault = 8;
        /// The function is faulty.
        FunctionFault = 9;
        /// Ground speed too high.
        SpeedTooHigh = 17;
        /// Oil level too low.
        OilLevelLow = 20;
        /// Hitch locked out.
        LockedOut = 21;
        /// Error.
        Error = 62;
        /// Not available.
        NotAvailable = 63;
    }
}

impl ExitCode {
    /// The reason of 6 bits; reserved ones are not available.
    #[must_use]
    pub fn from_bits(bits: u8) -> Self {
        Self::from_code(bits & 0x3F).unwrap_or(Self::NotAvailable)
    }
}

/// Rear hitch status as it is on the bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StatusMessage {
    /// Position, raw: 0.4 % a bit.
    pub position: u8,
    /// In work, or not.
    pub in_work: InWork,
    /// Limit status.
    pub limit: LimitStatus,
    /// Nominal lower link force, raw: 0.8 % a bit from -100 %.
    pub lower_link_force: u8,
    /// Draft, raw: 10 N a bit from -320 kN.
    pub draft: u16,
    /// Exit or reason code.
    pub exit: ExitCode,
}

impl StatusMessage {
    /// The status of a hitch whose nominal lower link force is not known.
    #[must_use]
    pub fn new(status: &HitchStatus, limit: LimitStatus, exit: ExitCode) -> Self {
        Self {
            position: raw_position(status.position),
            in_work: status.in_work,
            limit,
            lower_link_force: NOT_AVAILABLE,
            draft: raw_draft(status.draft),
            exit,
        }
    }

    /// As in the message.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; 8] {
        let [draft_low, draft_high] = self.draft.to_le_bytes();
        [
            self.position,
            ((self.in_work as u8) << 6) | ((self.limit as u8) << 3) | 0b111,
            self.lower_link_force,
            draft_low,
            draft_high,
            0b1100_0000 | self.exit as u8,
            0xFF,
            0xFF,
        ]
    }

    /// From a message.
    #[must_use]
    pub fn from_bytes(bytes: &[u8; 8]) -> Self {
        let [position, flags, lower_link_force, low, high, exit, _, _] = *bytes;
        Self {
            position,
            in_work: InWork::from_code(flags >> 6).unwrap_or_default(),
            limit: LimitStatus::from_code(flags >> 3 & 0x07).unwrap_or(LimitStatus::Reserved),
            lower_link_force,
            draft: u16::from_le_bytes([low, high]),
            exit: ExitCode::from_bits(exit),
        }
    }

    /// True if a status says something new. A position that trembles between two values doesn't, nor does the draft, which always
    /// changes.
    #[must_use]
    pub fn differs(status: &[u8; 8], last: &[u8; 8]) -> bool {
        let [position, flags, force, _, _, rest @ ..] = status;
        let [last_position, last_flags, last_force, _, _, last_rest @ ..] = last;
        (flags, force, rest) != (last_flags, last_force, last_rest)
            || position.abs_diff(*last_position) > 1
    }
}

/// What there is of the facilities of a tractor (ISO 11783-7, tractor facilities response): the position of the rear
/// hitch, its in-work indication if `has_in_work`, its draft if `has_draft`, and, if `is_commanded`, its commands and
/// their limit status. The class is "not available": a hitch alone has no class of ISO 11783-9, each of which begins with
/// power, speed and PTO. A bit that is 0 promises nothing; the indicator in byte 8 says that reserved bits are 0.
#[must_use]
pub const fn facilities(is_commanded: bool, has_draft: bool, has_in_work: bool) -> [u8; 8] {
    const NO_CLASS: u8 = 0b1100_0000;
    let commands = if is_commanded { 0b1000_1000 } else { 0 };
    let draft = if has_draft { 0b0000_0100 } else { 0 };
    let position = if has_in_work {
        0b1100_0000
    } else {
        0b1000_0000
    };
    [NO_CLASS, position, draft, commands, 0, 0, 0, 0]
}

/// Time until the implement is in work, in bytes 1 and 2: a millisecond a bit, and 65535 while it is not on its way there. The
/// group is a proprietary one: no public group has this time.
#[must_use]
pub fn time_until_work(time: Option<Millisecond>) -> [u8; 8] {
    let raw = time.map_or(scale::NOT_AVAILABLE, |time| TIME.raw(time.0));
    let [low, high] = raw.to_le_bytes();
    [low, high, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF]
}

/// What an implement asks of the rear hitch (SPN 1875).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HitchCommand {
    /// Nothing: control is given back.
    None,
    /// A position, raw: 0.4 % a bit.
    Position(u8),
    /// A reserved value, or the implement's own "error".
    OutOfRange,
}

impl HitchCommand {
    /// The command in a message of hitch and PTO commands.
    #[must_use]
    pub const fn from_bytes([_front, rear, ..]: &[u8; 8]) -> Self {
        match *rear {
            NOT_AVAILABLE => Self::None,
            raw if raw <= LARGEST => Self::Position(raw),
            _ => Self::OutOfRange,
        }
    }

    /// The message that asks for this and nothing else.
    #[must_use]
    pub const fn to_bytes(self) -> [u8; 8] {
        let rear = match self {
            Self::None => NOT_AVAILABLE,
            Self::Position(raw) => raw,
            Self::OutOfRange => ERROR,
        };
        [0xFF, rear, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF]
    }
}

/// The raw value of a position, rounded to nearest; what is beyond the ends is at the end.
#[must_use]
pub fn raw_position(position: Option<PerMille>) -> u8 {
    position.map_or(ERROR, |position| {
        let rounded = (position.0.clamp(0, 1000) + PER_MILLE_PER_BIT / 2) / PER_MILLE_PER_BIT;
        u8::try_from(rounded).unwrap_or(LARGEST)
    })
}

/// The raw value of a draft, rounded to nearest; what is beyond the ends is at the end.
fn raw_draft(draft: Draft) -> u16 {
    match draft {
        Draft::NotFitted => scale::NOT_AVAILABLE,
        Draft::Lost => scale::ERROR,
        Draft::Measured(draft) => DRAFT.raw(draft.0),
    }
}

/// The position of a raw value.
#[must_use]
pub fn position(raw: u8) -> PerMille {
    PerMille(i32::from(raw.min(LARGEST)) * PER_MILLE_PER_BIT)
}
