//! The text form of CAN, as hosts write it.

use hitch_protocols::can::slcan::{Adapter, Completed, decode, encode};
use hitch_protocols::can::{ExtendedId, Frame, Id, StandardId};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// What a host sends: an empty line, close, bit rate, open, questions, frames of each kind.
const SESSION: &[u8] =
    b"\rC\rS5\rO\rV\rN\rF\rT0CFE458089B47C8FF7DC0FFFF\rt07A1AB\rr07A3\rR1FFFFFFF0\rt07A0\r";

fn completed_by(adapter: &mut Adapter, text: &str) -> Vec<Completed> {
    text.bytes()
        .filter_map(|byte| adapter.receive(byte))
        .collect()
}

fn status() -> Frame {
    let id = ExtendedId::new(0x0CFE_4580).unwrap();
    Frame::of_eight(id, [0x9B, 0x47, 0xC8, 0xFF, 0x7D, 0xC0, 0xFF, 0xFF])
}

#[test]
fn frames_are_written_as_other_adapters_write_them() {
    assert_eq!(encode(&status()), *b"T0CFE458089B47C8FF7DC0FFFF\r");
    let standard = StandardId::new(0x7A).unwrap();
    let short = Frame::data_frame(standard.into(), &[0xAB]).unwrap();
    assert_eq!(encode(&short), *b"t07A1AB\r");
    assert_eq!(
        encode(&Frame::remote_frame(standard.into(), 3).unwrap()),
        *b"r07A3\r"
    );
    let extended = Id::Extended(ExtendedId::MAX);
    assert_eq!(
        encode(&Frame::remote_frame(extended, 0).unwrap()),
        *b"R1FFFFFFF0\r"
    );
}

#[test]
fn a_host_opens_sends_and_closes() {
    let mut adapter = Adapter::default();
    // What python-can and slcand begin with: an empty line, close, bit rate, open.
    let heard = completed_by(&mut adapter, "\rC\rS5\rO\r");
    assert!(
        heard
            .iter()
            .all(|heard| heard.reply == b"\r" && heard.frame.is_none())
    );
    assert!(adapter.is_open());
    let heard = completed_by(&mut adapter, "T0CFE458089B47C8FF7DC0FFFF\rt07A1ab\r");
    assert_eq!(heard[0].frame, Some(status()));
    assert_eq!(heard[0].reply, b"Z\r");
    assert_eq!(heard[1].frame.unwrap().data(), [0xAB], "small letters too");
    assert_eq!(heard[1].reply, b"z\r");
    completed_by(&mut adapter, "C\r");
    assert!(!adapter.is_open());
    assert_eq!(
        completed_by(&mut adapter, "t07A1AB\r")[0].reply,
        b"\x07",
        "closed"
    );
}

#[test]
fn an_adapter_that_listens_sends_nothing() {
    let mut adapter = Adapter::default();
    completed_by(&mut adapter, "L\r");
    assert!(adapter.is_open());
    assert_eq!(completed_by(&mut adapter, "t07A0\r")[0].frame, None);
}

#[test]
fn version_serial_and_flags_are_told() {
    let mut adapter = Adapter::default();
    let replies: Vec<&[u8]> = completed_by(&mut adapter, "V\rN\rF\r")
        .iter()
        .map(|heard| heard.reply)
        .collect();
    assert_eq!(replies, [&b"V1013\r"[..], b"NH1TC\r", b"F00\r"]);
}

#[test]
fn what_is_no_command_is_refused_and_the_next_line_counts_again() {
    let mut adapter = Adapter::default();
    completed_by(&mut adapter, "O\r");
    for line in [
        "x",
        "t",
        "t07",
        "t07A",
        "t07A9",
        "t07A1",
        "t07A1A",
        "t07A1ABC",
        "t8001AB",
        "tG7A0",
        "r07A9",
        "T200000000",
        "T0CFE4580",
        "r07A1AB",
        "t07A1G0",
        "T0CFE458089B47C8FF7DC0FFFF00000000000000000000000000000000",
    ] {
        let heard = completed_by(&mut adapter, &format!("{line}\r"));
        assert_eq!(
            heard,
            [Completed {
                frame: None,
                reply: b"\x07"
            }],
            "{line}"
        );
    }
    assert_eq!(completed_by(&mut adapter, "t07A0\r")[0].reply, b"z\r");
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(2), ..ProptestConfig::with_cases(500) })]

    #[test]
    fn every_frame_survives_its_text(raw in 0..0x2000_0000_u32, extended: bool, remote: bool, data in prop::collection::vec(any::<u8>(), 0..=8)) {
        let id = if extended {
            Id::Extended(ExtendedId::new(raw).unwrap())
        } else {
            Id::Standard(StandardId::new(u16::try_from(raw % 0x800).unwrap()).unwrap())
        };
        let frame = if remote { Frame::remote_frame(id, data.len()) } else { Frame::data_frame(id, &data) }.unwrap();
        let line = encode(&frame);
        prop_assert_eq!(line.last(), Some(&b'\r'));
        prop_assert_eq!(decode(&line[..line.len() - 1]), Some(frame));
    }

    #[test]
    fn no_bytes_do_harm(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let mut adapter = Adapter::default();
        bytes.iter().for_each(|&byte| { adapter.receive(byte); });
        completed_by(&mut adapter, "\rO\r");
        prop_assert!(adapter.is_open());
    }

    /// A session of a real host with single bytes lost, changed or inserted: the line after it counts again, and the adapter never
    /// answers more lines than it was sent.
    #[test]
    fn a_damaged_session_ends_with_the_line(
        damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..3_u8), 1..8)
    ) {
        let mut session = SESSION.to_vec();
        for (place, byte, kind) in damage {
            let at = place.index(session.len());
            match kind {
                0 => session[at] ^= 1 << (byte % 8),
                1 => session.insert(at, byte),
                _ => drop(session.remove(at)),
            }
        }
        let mut adapter = Adapter::default();
        let answers = session.iter().filter(|&&byte| adapter.receive(byte).is_some()).count();
        prop_assert!(answers <= session.iter().filter(|&&byte| byte == b'\r').count());
        completed_by(&mut adapter, "\rC\rS5\rO\r");
        let heard = completed_by(&mut adapter, "t07A1AB\r");
        prop_assert_eq!(heard[0].reply, b"z\r");
        let frame = heard[0].frame.unwrap();
        prop_assert_eq!(frame.data(), [0xAB]);
    }
}
