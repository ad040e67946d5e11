//! Long messages to the node: a commanded address, and what a sender can do wrong.

use hitch_protocols::j1939::{Pgn, Variant};

use crate::bus::{Bus, OTHER, OURS, Sent, name};

const WANTED: u8 = 0xC8;
const ALL: u8 = 0xFF;

/// The node's NAME and an address, in two packets.
fn packets(identity: u32, address: u8) -> [[u8; 8]; 2] {
    let [a, b, c, d, e, f, g, h] = name(identity).to_bytes();
    [
        [1, a, b, c, d, e, f, g],
        [2, h, address, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF],
    ]
}

fn announcement(control: u8) -> [u8; 8] {
    let [a, b, c] = Pgn::COMMANDED_ADDRESS.to_bytes();
    [control, 9, 0, 2, 0xFF, a, b, c]
}

fn manage(bus: &mut Bus, destination: u8, bytes: [u8; 8]) {
    bus.receive(Pgn::TRANSPORT_CONNECTION, destination, OTHER, &bytes);
}

fn send(bus: &mut Bus, destination: u8, packets: &[[u8; 8]]) {
    for packet in packets {
        bus.receive(Pgn::TRANSPORT_DATA, destination, OTHER, packet);
    }
}

fn said(bus: &mut Bus) -> Vec<Vec<u8>> {
    bus.run(5);
    let data = |sent: Sent| sent.data().to_vec();
    let sent = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert!(sent.iter().all(|sent| sent.id.destination == OTHER));
    sent.into_iter().map(data).collect()
}

fn abort(reason: u8) -> Vec<u8> {
    let [a, b, c] = Pgn::COMMANDED_ADDRESS.to_bytes();
    vec![255, reason, 0xFF, 0xFF, 0xFF, a, b, c]
}

#[test]
fn an_address_is_commanded_by_broadcast() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    manage(&mut bus, ALL, announcement(32));
    send(&mut bus, ALL, &packets(1, WANTED));
    bus.run(300);
    let claims = bus.take(Pgn::ADDRESS_CLAIMED);
    assert_eq!(claims[0].id.source, WANTED);
    assert_eq!(bus.node.address(), Some(WANTED));
}

#[test]
fn an_address_is_commanded_to_this_node_alone() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    manage(&mut bus, OURS, announcement(16));
    assert_eq!(said(&mut bus)[0][..3], [17, 2, 1], "clear to send both");
    let [first, last] = packets(1, WANTED);
    send(&mut bus, OURS, &[first]);
    assert!(said(&mut bus).is_empty());
    bus.receive(Pgn::TRANSPORT_DATA, OURS, OTHER, &last);
    // Its end is said from the new address only once that is claimed, so not at all.
    bus.run(300);
    assert_eq!(bus.node.address(), Some(WANTED));
}

#[test]
fn another_node_s_address_or_one_that_is_taken_changes_nothing() {
    for (identity, address) in [(2, WANTED), (1, OTHER), (1, OURS), (1, 0xFE), (1, 0xFF)] {
        let mut bus = Bus::claimed(Variant::Iso11783);
        bus.hear_claim(OTHER, name(0));
        manage(&mut bus, OURS, announcement(16));
        bus.run(5);
        bus.sent.clear();
        send(&mut bus, OURS, &packets(identity, address));
        assert_eq!(said(&mut bus)[0][..4], [19, 9, 0, 2], "received");
        bus.run(300);
        assert_eq!(bus.node.address(), Some(OURS));
    }
}

#[test]
fn what_a_hitch_makes_nothing_of_is_refused() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    let refused = [
        [16, 20, 0, 3, 0xFF, 0x00, 0xEF, 0],
        [16, 9, 0, 3, 0xFF, 0xD8, 0xFE, 0],
        [16, 10, 0, 2, 0xFF, 0xD8, 0xFE, 0],
        [16, 0, 0, 0, 0xFF, 0xD8, 0xFE, 0],
        [16, 0xFF, 0xFF, 0xFF, 0xFF, 0xD8, 0xFE, 0],
    ];
    for request in refused {
        manage(&mut bus, OURS, request);
        let said = said(&mut bus);
        assert_eq!(said[0][..2], [255, 2], "{request:?}");
        assert_eq!(said[0][5..], request[5..]);
    }
    manage(&mut bus, ALL, [32, 20, 0, 3, 0xFF, 0, 0xEF, 0]);
    assert!(
        said(&mut bus).is_empty(),
        "a broadcast is for whom it concerns"
    );
}

#[test]
fn one_message_at_a_time() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    manage(&mut bus, OURS, announcement(16));
    bus.run(5);
    bus.receive(Pgn::TRANSPORT_CONNECTION, OURS, 0x30, &announcement(16));
    bus.run(5);
    let sent = bus.take(Pgn::TRANSPORT_CONNECTION);
    let refusal = sent
        .iter()
        .find(|sent| sent.id.destination == 0x30)
        .unwrap();
    assert_eq!(refusal.data()[..2], [255, 2]);
    // Packets from the wrong node don't count; who asks again begins again.
    let [first, last] = packets(1, WANTED);
    bus.receive(Pgn::TRANSPORT_DATA, OURS, 0x30, &first);
    send(&mut bus, OURS, &[first]);
    manage(&mut bus, OURS, announcement(16));
    send(&mut bus, OURS, &[first, last]);
    bus.run(300);
    assert_eq!(bus.node.address(), Some(WANTED));
}

#[test]
fn a_sender_that_falls_silent_or_loses_a_packet_is_told() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    let [first, last] = packets(1, WANTED);
    manage(&mut bus, OURS, announcement(16));
    bus.run(5);
    bus.sent.clear();
    send(&mut bus, OURS, &[last]);
    assert_eq!(said(&mut bus), [abort(7)], "the first is missing");
    for wrong in [first, [0; 8], [0xFF; 8]] {
        manage(&mut bus, OURS, announcement(16));
        bus.run(5);
        bus.sent.clear();
        send(&mut bus, OURS, &[first, wrong]);
        assert_eq!(said(&mut bus), [abort(7)], "{wrong:?}");
    }
    manage(&mut bus, OURS, announcement(16));
    bus.run(5);
    bus.sent.clear();
    bus.run(800);
    assert_eq!(said(&mut bus), [abort(3)], "time-out");
    // A broadcast is given up without a word, and one that the sender gives up is forgotten.
    manage(&mut bus, ALL, announcement(32));
    send(&mut bus, ALL, &[last]);
    assert!(said(&mut bus).is_empty());
    manage(&mut bus, OURS, announcement(16));
    manage(&mut bus, OURS, [255, 1, 0xFF, 0xFF, 0xFF, 0xD8, 0xFE, 0]);
    bus.run(5);
    bus.sent.clear();
    send(&mut bus, OURS, &[first, last]);
    bus.run(800);
    assert!(bus.take(Pgn::TRANSPORT_CONNECTION).is_empty());
    assert_eq!(bus.node.address(), Some(OURS));
}
