//! XCP packets: the content of one frame.

use heapless::Vec;

use super::command::identifier;
use super::error::Refusal;

/// Maximum size of a packet, bytes, in both directions (MAX_CTO, MAX_DTO).
pub(super) const MOST_BYTES: usize = 8;

/// A packet: its identifier, then its content.
pub(super) type Packet = Vec<u8, MOST_BYTES>;

/// A packet; excess content is truncated.
pub(super) fn packet(identifier: u8, rest: &[u8]) -> Packet {
    core::iter::once(identifier)
        .chain(rest.iter().copied())
        .take(MOST_BYTES)
        .collect()
}

/// The first bytes after the code of a command.
pub(super) fn arguments<const N: usize>(rest: &[u8]) -> Result<[u8; N], Refusal> {
    rest.first_chunk().copied().ok_or(Refusal::Syntax)
}

/// Answer to a command; `None` if it is sent later.
pub(super) type Answer = Result<Option<Packet>, Refusal>;

/// Positive answer.
pub(super) fn done() -> Answer {
    response(&[])
}

/// Positive answer with these bytes.
pub(super) fn response(bytes: &[u8]) -> Answer {
    Ok(Some(packet(identifier::RESPONSE, bytes)))
}
