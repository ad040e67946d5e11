//! XCP session with the ECU: commands and answers.

use std::io;
use std::time::{Duration, Instant};

use hitch_protocols::can::Frame;
use hitch_protocols::j1939::{Id, Pgn};
use hitch_protocols::key::{SEED_BYTES, Secret};
use hitch_protocols::xcp::map::{IDENTITY, IDENTITY_BASE};

use super::can_client::CanClient;

/// The address of an off-board tool.
const TOOL_ADDRESS: u8 = 249;
const PRIORITY: u8 = 6;
/// An ECU sends its hitch status ten times a second after its address claim.
const APPEARS_WITHIN: Duration = Duration::from_secs(2);
const ANSWERS_WITHIN: Duration = Duration::from_millis(500);

/// First bytes of the ECU's packets.
const RESPONSE: u8 = 0xFF;
const ERROR: u8 = 0xFE;
const EVENT: u8 = 0xFD;

/// Faults of a session, with suggested correction.
#[derive(Debug, thiserror::Error)]
pub enum ToolError {
    /// The adapter is disconnected.
    #[error(
        "the connection to the bus was lost: {0}; check the adapter and its cable, and try again"
    )]
    Bus(#[from] io::Error),
    /// No hitch on the bus.
    #[error(
        "no hitch sent its status on the bus within 2 s; is the ECU running, and the bus up at 250 kbit/s?"
    )]
    NoHitch,
    /// The ECU has different tables.
    #[error(
        "the ECU is `{0}`, which does not match this program; build both from the same sources"
    )]
    OtherEcu(String),
    /// No answer.
    #[error("the ECU does not answer; check the cable, and that no other tool is connected")]
    Silent,
    /// Tuning isn't enabled.
    #[error("write access is disabled; close the service switch (`service on`)")]
    Locked,
    /// The hitch is not at rest.
    #[error("the hitch is not at rest; lock it first (`lock on`)")]
    NotAtRest,
    /// Safety values would be loosened.
    #[error(
        "`{first}`{} would be looser than stored, which requires the key of this machine; give it with --key FILE",
        and_others(*.others)
    )]
    Loosens {
        /// The first one.
        first: String,
        /// Number of others.
        others: usize,
    },
    /// The response to the challenge was wrong.
    #[error("the ECU refuses the key; give the key of this machine, after 10 s")]
    WrongKey,
    /// The ECU gives no challenge.
    #[error(
        "the ECU has no key, or a wrong one was given within the last 10 s; set a key, or try again"
    )]
    NoChallenge,
    /// A number is out of its range.
    #[error("the ECU refuses word {0} of the calibration: its value is out of range")]
    OutOfRange(usize),
    /// Anything else.
    #[error("the ECU refuses a command with code {0:#04x}")]
    Refused(u8),
    /// The calibration was not stored, or differs.
    #[error("the ECU could not store the calibration; the previous one remains valid")]
    NotStored,
}

/// The session.
#[derive(Debug)]
pub struct Session {
    client: CanClient,
    ecu: u8,
}

impl Session {
    /// Waits for a hitch on the bus, connects, and checks that its tables match those of this program.
    ///
    /// # Errors
    /// If there is no hitch, or its tables differ.
    pub fn open(mut client: CanClient) -> Result<Self, ToolError> {
        let ecu = find(&mut client)?;
        let mut session = Self { client, ecu };
        session.command(&[0xFF, 0])?;
        let identity = session.read(IDENTITY_BASE, IDENTITY.len())?;
        if identity == IDENTITY {
            Ok(session)
        } else {
            Err(ToolError::OtherEcu(
                String::from_utf8_lossy(&identity).into_owned(),
            ))
        }
    }

    /// Sends a command and waits for its answer, without the first byte.
    ///
    /// # Errors
    /// If the command is refused or not answered.
    pub fn command(&mut self, command: &[u8]) -> Result<Vec<u8>, ToolError> {
        let id = Id {
            priority: PRIORITY,
            pgn: Pgn::PROPRIETARY_A,
            destination: self.ecu,
            source: TOOL_ADDRESS,
        };
        let frame = Frame::data_frame(id.pack().into(), command).ok_or(ToolError::Silent)?;
        self.client.send(&frame)?;
        let deadline = Instant::now() + ANSWERS_WITHIN;
        loop {
            let packet = self.packet(deadline)?.ok_or(ToolError::Silent)?;
            match packet.split_first() {
                Some((&RESPONSE, answer)) => return Ok(answer.to_vec()),
                Some((&ERROR, code)) => return Err(refusal(code.first().copied().unwrap_or(0))),
                // Samples and events are not answers.
                _ => {}
            }
        }
    }

    /// The next event's number; `None` if none arrives before `deadline`.
    ///
    /// # Errors
    /// If the connection is closed.
    pub fn event(&mut self, deadline: Instant) -> Result<Option<u8>, ToolError> {
        while let Some(packet) = self.packet(deadline)? {
            if let [EVENT, number, ..] = packet[..] {
                return Ok(Some(number));
            }
        }
        Ok(None)
    }

    /// The next packet from the ECU; `None` if none arrives before `deadline`.
    ///
    /// # Errors
    /// If the connection is closed.
    pub fn packet(&mut self, deadline: Instant) -> Result<Option<Vec<u8>>, ToolError> {
        while let Some(frame) = self.client.receive(deadline)? {
            let id = frame.extended_data_id().map(Id::unpack);
            let ours = id.is_some_and(|id| {
                id.pgn == Pgn::PROPRIETARY_A
                    && id.source == self.ecu
                    && id.destination == TOOL_ADDRESS
            });
            if ours {
                return Ok(Some(frame.data().to_vec()));
            }
        }
        Ok(None)
    }

    /// Reads `count` bytes.
    ///
    /// # Errors
    /// If the ECU does not return them.
    pub fn read(&mut self, address: u32, count: usize) -> Result<Vec<u8>, ToolError> {
        const MOST: usize = 7;
        let mut bytes = Vec::new();
        for (piece, at) in (0..count).step_by(MOST).zip((address..).step_by(MOST)) {
            let [a, b, c, d] = at.to_le_bytes();
            let length = (count - piece).min(MOST);
            let answer = self.command(&[0xF4, length as u8, 0, 0, a, b, c, d])?;
            bytes.extend(answer.into_iter().take(length));
        }
        Ok(bytes)
    }

    /// Sets the address for subsequent writes.
    ///
    /// # Errors
    /// If the ECU refuses.
    pub fn set_address(&mut self, address: u32) -> Result<(), ToolError> {
        let [a, b, c, d] = address.to_le_bytes();
        self.command(&[0xF6, 0, 0, 0, a, b, c, d]).map(drop)
    }

    /// Unlocks the safety values by challenge and response.
    ///
    /// # Errors
    /// If the ECU gives no challenge, or refuses the response.
    pub fn unlock(&mut self, key: &Secret) -> Result<(), ToolError> {
        const CALIBRATION: u8 = 1;
        const PIECE: usize = 6;
        let protection = self.command(&[0xFD])?.get(1).copied().unwrap_or(0);
        if protection & CALIBRATION != 0 {
            return Err(ToolError::Locked);
        }
        let mut seed = Vec::new();
        for mode in [0, 1, 1] {
            let piece = self.command(&[0xF8, mode, CALIBRATION]);
            let piece = piece.map_err(|error| match error {
                ToolError::Locked => ToolError::NoChallenge,
                other => other,
            })?;
            seed.extend(piece.into_iter().skip(1).take(PIECE));
        }
        seed.truncate(SEED_BYTES);
        let seed = seed.try_into().map_err(|_| ToolError::NoChallenge)?;
        let response = key.response(&seed);
        for (piece, sent) in response.chunks(PIECE).zip((0..).step_by(PIECE)) {
            let left = (response.len() - sent) as u8;
            let answer = self.command(&[&[0xF7, left], piece].concat());
            answer.map_err(|error| match error {
                ToolError::Locked => ToolError::WrongKey,
                other => other,
            })?;
        }
        Ok(())
    }

    /// Ends the session.
    ///
    /// # Errors
    /// If the ECU doesn't answer.
    pub fn close(mut self) -> Result<(), ToolError> {
        self.command(&[0xFE]).map(drop)
    }
}

fn and_others(others: usize) -> String {
    match others {
        0 => String::new(),
        1 => " and one more value".to_owned(),
        _ => format!(" and {others} more values"),
    }
}

fn refusal(code: u8) -> ToolError {
    match code {
        0x24 => ToolError::NotAtRest,
        0x25 => ToolError::Locked,
        code => ToolError::Refused(code),
    }
}

/// The address of the hitch that sends its status.
fn find(client: &mut CanClient) -> Result<u8, ToolError> {
    let deadline = Instant::now() + APPEARS_WITHIN;
    while let Some(frame) = client.receive(deadline)? {
        let id = frame.extended_data_id().map(Id::unpack);
        if let Some(id) = id.filter(|id| id.pgn == Pgn::REAR_HITCH_STATUS) {
            return Ok(id.source);
        }
    }
    Err(ToolError::NoHitch)
}
