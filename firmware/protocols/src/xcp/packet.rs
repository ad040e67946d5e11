//! What fits into one frame.

use heapless::Vec;

use super::command::identifier;
use super::error::Refusal;

/// Bytes of a packet at most, both ways (MAX_CTO, MAX_DTO).
pub(super) const MOST_BYTES: usize = 8;

/// A packet: its identifier, then what belongs to it.
pub(super) type Packet = Vec<u8, MOST_BYTES>;

/// A packet; what doesn't fit is cut off.
pub(super) fn packet(identifier: u8, rest: &[u8]) -> Packet {
    core::iter::once(identifier)
        .chain(rest.iter().copied())
        .take(MOST_BYTES)
        .collect()
}

/// What a command is answered with; `None`: the answer comes later.
pub(super) type Answer = Result<Option<Packet>, Refusal>;

/// The answer that a command was obeyed.
pub(super) fn done() -> Answer {
    response(&[])
}

/// The answer with these bytes.
pub(super) fn response(bytes: &[u8]) -> Answer {
    Ok(Some(packet(identifier::RESPONSE, bytes)))
}
