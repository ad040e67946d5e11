//! The transport of what is too long for a frame.

use hitch_protocols::j1939::{Pgn, Trouble, Troubles, Variant};

use crate::bus::{Bus, OTHER, OURS, Sent};
use crate::diagnostics::troubles;

/// Puts a broadcast together again, as a receiver does.
fn reassembled(sent: &[Sent], group: Pgn) -> Vec<u8> {
    let announcement = sent
        .iter()
        .find(|sent| sent.id.pgn == Pgn::TRANSPORT_CONNECTION)
        .expect("a broadcast is announced");
    let [control, low, high, packets, 0xFF, a, b, c] = *announcement.frame.eight().unwrap() else {
        panic!("{announcement:?}");
    };
    assert_eq!((control, Pgn::from_bytes([a, b, c])), (32, group));
    assert_eq!(announcement.id.destination, 0xFF);
    let data: Vec<&Sent> = sent
        .iter()
        .filter(|sent| sent.id.pgn == Pgn::TRANSPORT_DATA)
        .take(usize::from(packets))
        .collect();
    assert_eq!(data.len(), usize::from(packets));
    for (number, pair) in (1_u8..).zip(data.windows(2)) {
        assert_eq!(pair[0].data()[0], number);
        let gap_ms = pair[1].at_ms.wrapping_sub(pair[0].at_ms);
        assert!((50..=200).contains(&gap_ms), "{gap_ms} ms");
    }
    let mut bytes: Vec<u8> = data
        .iter()
        .flat_map(|sent| sent.data()[1..].to_vec())
        .collect();
    bytes.truncate(usize::from(u16::from_le_bytes([low, high])));
    bytes
}

/// Packets of a message with all codes: of seven bytes, one each 50 ms.
fn all_packets() -> u32 {
    u32::try_from((2 + 4 * Trouble::ALL.len()).div_ceil(7)).unwrap()
}

#[test]
fn several_codes_go_as_a_broadcast() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.status.troubles = troubles(Trouble::ALL);
    bus.run(100 + 50 * all_packets());
    let bytes = reassembled(&bus.sent, Pgn::DM1);
    assert_eq!(bytes.len(), 2 + 4 * Trouble::ALL.len());
    for (trouble, code) in Trouble::ALL.iter().zip(bytes[2..].chunks(4)) {
        let spn = u32::from(code[0]) | u32::from(code[1]) << 8 | u32::from(code[2] >> 5) << 16;
        assert_eq!(
            (spn, code[2] & 0x1F),
            (trouble.code().spn, trouble.code().fmi)
        );
    }
}

/// A bus on which DM2 is too long for a frame.
fn bus_with_history() -> Bus {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.status.troubles = troubles(Trouble::ALL);
    bus.step();
    bus.status.troubles = Troubles::NONE;
    // Until their broadcast has ended.
    bus.run(150 + 50 * all_packets());
    bus.sent.clear();
    bus
}

fn management(bus: &mut Bus, data: [u8; 5]) {
    let [a, b, c] = Pgn::DM2.to_bytes();
    let [control, first, second, third, fourth] = data;
    let bytes = [control, first, second, third, fourth, a, b, c];
    bus.receive(Pgn::TRANSPORT_CONNECTION, OURS, OTHER, &bytes);
}

fn packets(bus: &mut Bus) -> Vec<u8> {
    let data = bus.take(Pgn::TRANSPORT_DATA);
    data.iter().map(|sent| sent.data()[0]).collect()
}

#[test]
fn one_node_gets_a_long_message_at_its_own_pace() {
    let mut bus = bus_with_history();
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    let length = 2 + 4 * Trouble::ALL.len();
    let count = u8::try_from(length.div_ceil(7)).unwrap();
    let request = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert_eq!(
        request[0].data(),
        [
            16,
            u8::try_from(length).unwrap(),
            0,
            count,
            0xFF,
            0xCB,
            0xFE,
            0
        ]
    );
    assert_eq!(request[0].id.destination, OTHER);
    bus.run(1_000);
    assert_eq!(
        packets(&mut bus),
        [0; 0],
        "nothing before it is cleared to send"
    );
    management(&mut bus, [17, 3, 1, 0xFF, 0xFF]);
    bus.run(50);
    assert_eq!(packets(&mut bus), [1, 2, 3]);
    management(&mut bus, [17, 0, 4, 0xFF, 0xFF]);
    bus.run(1_000);
    assert_eq!(packets(&mut bus), [0; 0], "told to wait");
    management(&mut bus, [17, 2, 2, 0xFF, 0xFF]);
    bus.run(50);
    assert_eq!(packets(&mut bus), [2, 3], "asked for again");
    management(&mut bus, [17, 0xFF, 4, 0xFF, 0xFF]);
    management(&mut bus, [17, 0xFF, 4, 0xFF, 0xFF]);
    bus.run(100);
    assert_eq!(packets(&mut bus), (4..=count).collect::<Vec<u8>>());
    management(
        &mut bus,
        [19, u8::try_from(length).unwrap(), 0, count, 0xFF],
    );
    bus.run(3_000);
    assert!(bus.take(Pgn::TRANSPORT_CONNECTION).is_empty(), "over");
}

#[test]
fn a_partner_that_falls_silent_or_asks_for_nonsense_ends_it() {
    let mut bus = bus_with_history();
    bus.ask(Pgn::DM2, OURS);
    bus.run(1_300);
    let ended = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert_eq!(
        ended[1].data(),
        [255, 3, 0xFF, 0xFF, 0xFF, 0xCB, 0xFE, 0],
        "time-out"
    );
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    management(&mut bus, [17, 1, 200, 0xFF, 0xFF]);
    bus.run(5);
    let ended = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert_eq!(ended[1].data()[..2], [255, 7], "no such packet");
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    management(&mut bus, [255, 1, 0xFF, 0xFF, 0xFF]);
    bus.run(2_000);
    assert_eq!(bus.take(Pgn::TRANSPORT_CONNECTION).len(), 1, "they gave up");
}

#[test]
fn a_second_long_message_has_to_wait_and_is_told_so() {
    let mut bus = bus_with_history();
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    bus.receive(Pgn::REQUEST, OURS, 0x30, &Pgn::DM2.to_bytes());
    bus.run(5);
    let refusal = bus.take(Pgn::ACKNOWLEDGEMENT);
    assert_eq!(
        refusal[0].data()[..5],
        [3, 0xFF, 0xFF, 0xFF, 0x30],
        "cannot respond now"
    );
}

#[test]
fn others_have_no_say_in_a_connection() {
    let mut bus = bus_with_history();
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    let [a, b, c] = Pgn::DM2.to_bytes();
    for control in [[17, 3, 1], [255, 1, 0xFF], [19, 0, 0]] {
        let [first, second, third] = control;
        let bytes = [first, second, third, 0xFF, 0xFF, a, b, c];
        bus.receive(Pgn::TRANSPORT_CONNECTION, OURS, 0x30, &bytes);
    }
    bus.run(50);
    assert_eq!(packets(&mut bus), [0; 0]);
    management(&mut bus, [17, 1, 1, 0xFF, 0xFF]);
    bus.run(50);
    assert_eq!(packets(&mut bus), [1]);
}

#[test]
fn the_software_says_what_it_is() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.ask(Pgn::SOFTWARE_IDENTIFICATION, 0xFF);
    bus.run(200);
    let text = reassembled(&bus.sent, Pgn::SOFTWARE_IDENTIFICATION);
    assert_eq!(text, b"\x01hitch 1*");
}

#[test]
fn who_asks_everybody_gets_the_answer_after_the_broadcast_under_way() {
    let mut bus = bus_with_history();
    bus.status.troubles = troubles(&[Trouble::SupplyLow, Trouble::LeverHigh]);
    bus.run(20);
    assert_eq!(bus.take(Pgn::TRANSPORT_CONNECTION).len(), 1, "DM1 begins");
    bus.ask(Pgn::DM2, 0xFF);
    bus.run(2_500);
    let group = |sent: &Sent| Pgn::from_bytes(*sent.data()[5..].first_chunk().unwrap());
    let begun = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert_eq!(group(&begun[0]), Pgn::DM2);
    assert!(
        begun.iter().skip(1).all(|sent| group(sent) == Pgn::DM1),
        "once"
    );
}
