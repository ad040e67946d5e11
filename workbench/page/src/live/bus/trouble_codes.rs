//! Active trouble codes (DM1): in one frame, or by broadcast in packets (SAE J1939-21 and -73).

use hitch_protocols::j1939::Pgn;
use hitch_protocols::j1939::trouble::Code;

/// First byte of the announcement of a broadcast.
const BAM: u8 = 32;
/// Longest message of the transport protocol, bytes.
const LONGEST: usize = 1_785;
/// Bytes before the first code: lamps.
const LAMPS: usize = 2;
/// Bytes of a code.
const CODE: usize = 4;

/// Receives messages of trouble codes.
#[derive(Debug, Default)]
pub struct TroubleCodes {
    broadcast: Option<Broadcast>,
}

/// A broadcast in progress.
#[derive(Debug)]
struct Broadcast {
    length: usize,
    bytes: Vec<u8>,
    /// Number of the next packet, counted from 1.
    next: u8,
}

impl TroubleCodes {
    /// Processes a frame of one node to all; the codes, if the frame completes a message of them.
    pub fn receive(&mut self, group: Pgn, data: &[u8]) -> Option<Vec<Code>> {
        match (group, data) {
            (Pgn::DM1, data) => Some(codes(data)),
            (Pgn::TRANSPORT_CONNECTION, &[BAM, low, high, _, _, a, b, c]) => {
                let length = usize::from(u16::from_le_bytes([low, high]));
                let is_dm1 = Pgn::from_bytes([a, b, c]) == Pgn::DM1 && length <= LONGEST;
                self.broadcast = is_dm1.then_some(Broadcast {
                    length,
                    bytes: Vec::new(),
                    next: 1,
                });
                None
            }
            (Pgn::TRANSPORT_DATA, &[number, ref packet @ ..]) => self.packet(number, packet),
            _ => None,
        }
    }

    fn packet(&mut self, number: u8, packet: &[u8]) -> Option<Vec<Code>> {
        let mut broadcast = self.broadcast.take()?;
        // After a lost packet, the next message comes within a second.
        if number != broadcast.next {
            return None;
        }
        broadcast.bytes.extend(packet);
        broadcast.next = number.wrapping_add(1);
        if broadcast.bytes.len() < broadcast.length {
            self.broadcast = Some(broadcast);
            return None;
        }
        broadcast.bytes.truncate(broadcast.length);
        Some(codes(&broadcast.bytes))
    }
}

/// The codes of a message; zeros stand for no code, and ones fill it up.
fn codes(message: &[u8]) -> Vec<Code> {
    let all = message.get(LAMPS..).unwrap_or_default();
    let code = |bytes: &[u8]| {
        let [low, high, top, _] = *bytes else {
            return None;
        };
        let spn = u32::from_le_bytes([low, high, top >> 5, 0]);
        let is_code = bytes != [0; CODE] && bytes != [0xFF; CODE];
        is_code.then_some(Code {
            spn,
            fmi: top & 0x1F,
        })
    };
    all.chunks_exact(CODE).filter_map(code).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_protocols::can::Frame;
    use hitch_protocols::j1939::diagnostics::{Diagnostics, KINDS};
    use hitch_protocols::j1939::transport::Transport;
    use hitch_protocols::j1939::{GLOBAL, Id, Trouble, Troubles, Variant};

    fn message(troubles: &[Trouble]) -> Vec<u8> {
        let mut diagnostics = Diagnostics::new(Variant::Iso11783, &[0; KINDS]);
        let mut active = Troubles::NONE;
        troubles.iter().for_each(|&one| active.insert(one));
        diagnostics.update(active);
        diagnostics.dm1().to_vec()
    }

    fn broadcast(troubles: &[Trouble]) -> Vec<Frame> {
        let mut transport = Transport::default();
        let bytes = message(troubles).into_iter().collect();
        transport.send(Pgn::DM1, bytes, GLOBAL, 0);
        (0..5_000)
            .filter_map(|now_ms| transport.poll(0x80, now_ms))
            .collect()
    }

    fn received(frames: &[Frame]) -> Vec<Vec<Code>> {
        let mut codes = TroubleCodes::default();
        let group = |frame: &Frame| Id::unpack(frame.extended_data_id().unwrap()).pgn;
        let each = frames
            .iter()
            .filter_map(|frame| codes.receive(group(frame), frame.data()));
        each.collect()
    }

    #[test]
    fn codes_of_one_frame_and_of_a_broadcast_are_those_of_the_firmware() {
        let mut codes = TroubleCodes::default();
        let one = [Trouble::SupplyLow];
        let alone = codes.receive(Pgn::DM1, &message(&one));
        assert_eq!(alone, Some(vec![Trouble::SupplyLow.code()]));
        assert_eq!(codes.receive(Pgn::DM1, &message(&[])), Some(vec![]));
        let all = received(&broadcast(Trouble::ALL));
        let expected: Vec<Code> = Trouble::ALL.iter().map(|one| one.code()).collect();
        assert_eq!(all, [expected]);
    }

    #[test]
    fn a_broadcast_with_a_lost_packet_is_dropped() {
        let mut frames = broadcast(Trouble::ALL);
        frames.remove(3);
        assert_eq!(received(&frames), Vec::<Vec<Code>>::new());
    }
}
