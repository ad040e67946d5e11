//! Transmission of more than eight bytes: by broadcast, or by connection to one node (SAE J1939-21, ISO 11783-3).
//!
//! ```text
//! broadcast:   BAM, then a packet every 50 ms
//! to one node: RTS -> CTS (n packets from k on) -> n packets -> CTS ... -> end of message acknowledged
//!                     CTS (0): wait              no answer in time: abort
//! ```
//!
//! One of each can be in progress. Reception is in [`super::reception`].

use heapless::Vec;

use super::diagnostics::LONGEST_MESSAGE;
use super::id::{GLOBAL, Id, Pgn};
use super::time::{reached, since_ms};
use crate::can::Frame;

/// Interval between packets of a broadcast, ms; the standard allows 50 to 200.
const BROADCAST_SPACING_MS: u32 = 50;
/// Interval between packets of a connection, ms; chosen for at most a quarter of a slow bus.
const SPACING_MS: u32 = 2;
/// Time-out of an answer (T3), ms.
const ANSWER_MS: u32 = 1_250;
/// Time-out after a wait request (T4), ms.
const HOLD_MS: u32 = 1_050;
/// Priority of the transport protocol.
const PRIORITY: u8 = 7;
/// Bytes in a packet.
pub(super) const PACKET: usize = 7;

pub(super) const RTS: u8 = 16;
pub(super) const CTS: u8 = 17;
pub(super) const END_OF_MESSAGE: u8 = 19;
pub(super) const BAM: u8 = 32;
pub(super) const ABORT: u8 = 255;

/// Reason for the abort of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum AbortReason {
    /// No room for another connection.
    Resources = 2,
    /// Time-out of an answer.
    Timeout = 3,
    /// The receiver requested packets that do not exist.
    BadSequence = 7,
}

/// A message in transmission.
#[derive(Clone, Debug)]
struct Message {
    group: Pgn,
    bytes: Vec<u8, LONGEST_MESSAGE>,
}

impl Message {
    fn packets(&self) -> u8 {
        u8::try_from(self.bytes.len().div_ceil(PACKET)).unwrap_or(u8::MAX)
    }

    /// Announcement.
    fn announcement(&self, control: u8, last: u8) -> [u8; 8] {
        let [low, high, ..] = self.bytes.len().to_le_bytes();
        let [a, b, c] = self.group.to_bytes();
        [control, low, high, self.packets(), last, a, b, c]
    }

    /// Packet `number`, counted from 1, filled up with ones.
    fn packet(&self, number: u8) -> [u8; 8] {
        let mut packet = [0xFF; 8];
        let first = PACKET * usize::from(number.saturating_sub(1));
        let source = self.bytes.get(first..).unwrap_or(&[]);
        let (head, targets) = packet.split_at_mut(1);
        head.fill(number);
        for (target, byte) in targets.iter_mut().zip(source) {
            *target = *byte;
        }
        packet
    }
}

/// A broadcast in progress.
#[derive(Clone, Debug)]
struct Broadcast {
    message: Message,
    /// 0 is the announcement.
    next: u8,
    due_ms: u32,
}

/// State of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// RTS has to be sent.
    Begin,
    /// Waiting for the receiver until this time.
    Waiting { since_ms: u32, limit_ms: u32 },
    /// Packets `next` to `last` have to be sent.
    Sending { next: u8, last: u8, due_ms: u32 },
    /// The receiver requested packets that do not exist.
    Refused,
}

/// A message to one node.
#[derive(Clone, Debug)]
struct Connection {
    message: Message,
    partner: u8,
    stage: Stage,
}

/// Transmissions in progress.
#[derive(Clone, Debug, Default)]
pub struct Transport {
    broadcast: Option<Broadcast>,
    connection: Option<Connection>,
}

impl Transport {
    /// Discards all transmissions silently, because the address is lost.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Whether a message to `destination` can be started.
    #[must_use]
    pub const fn has_room(&self, destination: u8) -> bool {
        if destination == GLOBAL {
            self.broadcast.is_none()
        } else {
            self.connection.is_none()
        }
    }

    /// Starts a transmission; the caller has checked that it can be started.
    pub fn send(
        &mut self,
        group: Pgn,
        bytes: Vec<u8, LONGEST_MESSAGE>,
        destination: u8,
        now_ms: u32,
    ) {
        let message = Message { group, bytes };
        if destination == GLOBAL {
            self.broadcast = Some(Broadcast {
                message,
                next: 0,
                due_ms: now_ms,
            });
        } else {
            self.connection = Some(Connection {
                message,
                partner: destination,
                stage: Stage::Begin,
            });
        }
    }

    /// Processes a message of connection management to this node.
    pub fn receive(&mut self, bytes: &[u8; 8], source: u8, now_ms: u32) {
        let [control, first, second, _, _, group @ ..] = *bytes;
        let group = Pgn::from_bytes(group);
        let connection = self.connection.as_mut();
        let ours = |of: &&mut Connection| of.partner == source && of.message.group == group;
        let Some(connection) = connection.filter(ours) else {
            return;
        };
        match control {
            CTS => connection.clear_to_send(first, second, now_ms),
            END_OF_MESSAGE | ABORT => self.connection = None,
            _ => {}
        }
    }

    /// The next frame that is due.
    pub fn poll(&mut self, source: u8, now_ms: u32) -> Option<Frame> {
        self.poll_connection(source, now_ms)
            .or_else(|| self.poll_broadcast(source, now_ms))
    }

    fn poll_broadcast(&mut self, source: u8, now_ms: u32) -> Option<Frame> {
        let broadcast = self
            .broadcast
            .as_mut()
            .filter(|broadcast| reached(broadcast.due_ms, now_ms))?;
        let number = broadcast.next;
        broadcast.next = number.saturating_add(1);
        broadcast.due_ms = now_ms.wrapping_add(BROADCAST_SPACING_MS);
        let message = &broadcast.message;
        let frame = if number == 0 {
            connection_frame(message.announcement(BAM, 0xFF), GLOBAL, source)
        } else {
            data_frame(message.packet(number), GLOBAL, source)
        };
        if number >= message.packets() {
            self.broadcast = None;
        }
        Some(frame)
    }

    fn poll_connection(&mut self, source: u8, now_ms: u32) -> Option<Frame> {
        let connection = self.connection.as_mut()?;
        let partner = connection.partner;
        let message = &connection.message;
        match connection.stage {
            Stage::Begin => {
                let request = message.announcement(RTS, 0xFF);
                connection.wait(ANSWER_MS, now_ms);
                Some(connection_frame(request, partner, source))
            }
            Stage::Sending { next, last, due_ms } if reached(due_ms, now_ms) => {
                let packet = message.packet(next);
                if next >= last {
                    connection.wait(ANSWER_MS, now_ms);
                } else {
                    connection.stage = Stage::Sending {
                        next: next.saturating_add(1),
                        last,
                        due_ms: now_ms.wrapping_add(SPACING_MS),
                    };
                }
                Some(data_frame(packet, partner, source))
            }
            Stage::Waiting {
                since_ms: since,
                limit_ms,
            } if since_ms(since, now_ms) > limit_ms => {
                Some(self.give_up(AbortReason::Timeout, partner, source))
            }
            Stage::Refused => Some(self.give_up(AbortReason::BadSequence, partner, source)),
            Stage::Waiting { .. } | Stage::Sending { .. } => None,
        }
    }
}

impl Transport {
    /// Aborts the connection with a reason.
    fn give_up(&mut self, reason: AbortReason, partner: u8, source: u8) -> Frame {
        let group = self
            .connection
            .take()
            .map_or(Pgn(0), |connection| connection.message.group);
        connection_frame(abort(reason, group), partner, source)
    }
}

impl Connection {
    const fn wait(&mut self, limit_ms: u32, now_ms: u32) {
        self.stage = Stage::Waiting {
            since_ms: now_ms,
            limit_ms,
        };
    }

    /// The receiver requests `count` packets from `first`. While packets are being sent it is a duplicate frame.
    fn clear_to_send(&mut self, count: u8, first: u8, now_ms: u32) {
        let Stage::Waiting { .. } = self.stage else {
            return;
        };
        let packets = self.message.packets();
        let last = first.saturating_add(count).saturating_sub(1).min(packets);
        if count == 0 {
            self.wait(HOLD_MS, now_ms);
        } else if (1..=packets).contains(&first) {
            self.stage = Stage::Sending {
                next: first,
                last,
                due_ms: now_ms,
            };
        } else {
            self.stage = Stage::Refused;
        }
    }
}

/// Abort of a connection, or refusal of one.
pub(super) const fn abort(reason: AbortReason, group: Pgn) -> [u8; 8] {
    let [a, b, c] = group.to_bytes();
    [ABORT, reason as u8, 0xFF, 0xFF, 0xFF, a, b, c]
}

pub(super) fn connection_frame(bytes: [u8; 8], destination: u8, source: u8) -> Frame {
    frame(Pgn::TRANSPORT_CONNECTION, bytes, destination, source)
}

fn data_frame(bytes: [u8; 8], destination: u8, source: u8) -> Frame {
    frame(Pgn::TRANSPORT_DATA, bytes, destination, source)
}

fn frame(pgn: Pgn, bytes: [u8; 8], destination: u8, source: u8) -> Frame {
    let id = Id::broadcast(pgn, PRIORITY, source);
    id.to(destination).frame(bytes)
}
