//! Reception of more than eight bytes: broadcasts, and messages to this node (SAE J1939-21, ISO 11783-3).
//!
//! ```text
//!          BAM, or RTS: say CTS        packets 1, 2, ... in order          the last one; after RTS: say "end of
//!   message"
//!  +------+ -----------------> +-----------+ --+   +-----------+ ----------> the message
//!  | Idle |                    | Receiving | <-+   | Receiving |
//!  +------+ <----------------- +-----------+       +-----------+
//!             750 ms of silence, an abort, or another packet than the next; after RTS: say so
//! ```
//!
//! One message at a time is received, and only the group that a hitch uses: a commanded address. Other connections are
//! refused; other broadcasts are ignored.

use heapless::Vec;

use super::id::Pgn;
use super::time::since_ms;
use super::transport::{
    ABORT, AbortReason, BAM, CTS, END_OF_MESSAGE, PACKET, RTS, abort, connection_frame,
};
use crate::can::Frame;

/// Bytes of the longest received message, the commanded address.
const LONGEST: usize = 9;
/// Time-out of the next packet (T1), ms.
const SILENCE_MS: u32 = 750;

/// A message that was received.
pub type Received = Vec<u8, LONGEST>;

/// A message in progress.
#[derive(Clone, Debug)]
struct Session {
    from: u8,
    is_broadcast: bool,
    group: Pgn,
    length: usize,
    bytes: Received,
    /// Number of the next packet, counted from 1.
    next: u8,
    heard_ms: u32,
}

impl Session {
    /// The announced message, if its group is received.
    fn announced(bytes: &[u8; 8], from: u8, now_ms: u32) -> Option<Self> {
        let [control, low, high, packets, _, group @ ..] = *bytes;
        let length = usize::from(u16::from_le_bytes([low, high]));
        let fits = usize::from(packets) == length.div_ceil(PACKET) && length == LONGEST;
        let group = Pgn::from_bytes(group);
        (fits && group == Pgn::COMMANDED_ADDRESS).then_some(Self {
            from,
            is_broadcast: control == BAM,
            group,
            length,
            bytes: Received::new(),
            next: 1,
            heard_ms: now_ms,
        })
    }
}

/// The receiver.
#[derive(Clone, Debug, Default)]
pub struct Reception {
    session: Option<Session>,
    /// Pending response and its destination.
    reply: Option<([u8; 8], u8)>,
}

impl Reception {
    /// Processes a message of connection management, to all (`is_broadcast`) or to this node.
    pub fn manage(&mut self, bytes: &[u8; 8], from: u8, is_broadcast: bool, now_ms: u32) {
        let [control, .., a, b, c] = *bytes;
        let group = Pgn::from_bytes([a, b, c]);
        match (control, is_broadcast) {
            (BAM, true) if self.session.is_none() => {
                self.session = Session::announced(bytes, from, now_ms);
            }
            (RTS, false) => self.asked(bytes, from, group, now_ms),
            (ABORT, false) if self.is_of(from, false) => self.session = None,
            _ => {}
        }
    }

    /// A node requests a connection. A repeated request restarts it.
    fn asked(&mut self, bytes: &[u8; 8], from: u8, group: Pgn, now_ms: u32) {
        let is_free = self.session.is_none() || self.is_of(from, false);
        let session = Session::announced(bytes, from, now_ms).filter(|_| is_free);
        let [_, _, _, packets, _, a, b, c] = *bytes;
        let reply = match session {
            Some(_) => {
                self.session = session;
                [CTS, packets, 1, 0xFF, 0xFF, a, b, c]
            }
            None => abort(AbortReason::Resources, group),
        };
        self.reply = Some((reply, from));
    }

    /// Processes a packet; returns the message after the last one.
    pub fn packet(
        &mut self,
        bytes: &[u8; 8],
        from: u8,
        is_broadcast: bool,
        now_ms: u32,
    ) -> Option<Received> {
        if !self.is_of(from, is_broadcast) {
            return None;
        }
        let session = self.session.as_mut()?;
        let [number, data @ ..] = *bytes;
        if number != session.next {
            self.give_up(AbortReason::BadSequence);
            return None;
        }
        session.next = number.saturating_add(1);
        session.heard_ms = now_ms;
        let missing = session.length.saturating_sub(session.bytes.len());
        for byte in data.into_iter().take(missing) {
            // A length that does not fit was refused; `extend` would panic here, which the linker cannot exclude.
            let _ = session.bytes.push(byte);
        }
        if session.bytes.len() < session.length {
            return None;
        }
        let session = self.session.take()?;
        if !session.is_broadcast {
            let [low, high, ..] = session.length.to_le_bytes();
            let [a, b, c] = session.group.to_bytes();
            self.reply = Some(([END_OF_MESSAGE, low, high, number, 0xFF, a, b, c], from));
        }
        Some(session.bytes)
    }

    /// The pending response; updates the time-outs.
    pub fn poll(&mut self, source: u8, now_ms: u32) -> Option<Frame> {
        let silent = |session: &Session| since_ms(session.heard_ms, now_ms) > SILENCE_MS;
        if self.session.as_ref().is_some_and(silent) {
            self.give_up(AbortReason::Timeout);
        }
        let (bytes, destination) = self.reply.take()?;
        Some(connection_frame(bytes, destination, source))
    }

    fn is_of(&self, from: u8, is_broadcast: bool) -> bool {
        let session = self.session.as_ref();
        session.is_some_and(|session| session.from == from && session.is_broadcast == is_broadcast)
    }

    /// Ends the current message; the sender of a connection gets the reason.
    fn give_up(&mut self, reason: AbortReason) {
        if let Some(session) = self.session.take()
            && !session.is_broadcast
        {
            self.reply = Some((abort(reason, session.group), session.from));
        }
    }
}
