//! Claiming an address: who wins, who moves, who is silent.

use crate::bus::{Bus, OURS, Sent, name};
use hitch_protocols::j1939::diagnostics::KINDS;
use hitch_protocols::j1939::{Name, NameFields, Node, Pgn, Settings, Trouble, Variant};

/// Wins against ours.
fn better() -> Name {
    name(0)
}

/// Loses against ours.
fn worse() -> Name {
    name(2)
}

#[test]
fn a_node_claims_and_then_says_nothing_for_250_ms() {
    let mut bus = Bus::new(Variant::J1939);
    let start = bus.now_ms;
    bus.run(400);
    let (claim, rest) = bus.sent.split_first().unwrap();
    assert_eq!(
        claim.frame.extended_data_id().unwrap().as_raw(),
        0x18EE_FF80
    );
    assert_eq!(claim.data(), name(1).to_bytes());
    assert_eq!(claim.at_ms, start);
    assert_eq!(rest[0].at_ms.wrapping_sub(start), 250);
}

#[test]
fn a_lesser_claim_is_answered_and_changes_nothing() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.hear_claim(OURS, worse());
    bus.run(10);
    let answers = bus.take(Pgn::ADDRESS_CLAIMED);
    assert_eq!(answers.len(), 1);
    assert_eq!(answers[0].data(), name(1).to_bytes());
    assert_eq!(bus.node.address(), Some(OURS));
}

#[test]
fn a_better_claim_takes_the_address_and_the_next_free_one_is_claimed() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.hear_claim(0x81, worse());
    bus.hear_claim(OURS, better());
    assert_eq!(bus.node.address(), None, "from the same moment on");
    bus.run(250);
    let silence = bus.sent.clone();
    assert_eq!(silence.len(), 1, "a claim and nothing else: {silence:?}");
    assert_eq!(silence[0].id.source, 0x82, "0x81 is taken");
    bus.run(2);
    assert_eq!(bus.node.address(), Some(0x82));
    assert!(bus.sent.len() > 1, "and life goes on");
}

#[test]
fn a_claim_is_lost_while_it_waits_too() {
    let mut bus = Bus::new(Variant::Iso11783);
    bus.run(100);
    bus.hear_claim(OURS, better());
    bus.run(250);
    assert_eq!(bus.node.address(), None);
    bus.run(2);
    assert_eq!(bus.node.address(), Some(0x81));
    assert!(
        bus.sent
            .iter()
            .all(|sent| sent.id.pgn == Pgn::ADDRESS_CLAIMED || sent.id.source == 0x81)
    );
}

#[test]
fn requests_for_the_claim_are_answered_even_while_waiting() {
    let mut bus = Bus::new(Variant::Iso11783);
    bus.run(100);
    bus.sent.clear();
    bus.ask(Pgn::ADDRESS_CLAIMED, 0xFF);
    bus.run(10);
    assert_eq!(bus.take(Pgn::ADDRESS_CLAIMED).len(), 1);
    bus.run(200);
    bus.sent.clear();
    // Asked by a node that hasn't claimed yet, and at our own address.
    bus.receive(Pgn::REQUEST, OURS, 0xFE, &Pgn::ADDRESS_CLAIMED.to_bytes());
    bus.run(10);
    let answers = bus.take(Pgn::ADDRESS_CLAIMED);
    assert_eq!(answers.len(), 1, "claimed, not acknowledged");
    assert_eq!(answers[0].id.source, OURS);
}

#[test]
fn without_a_free_address_it_says_so_from_the_null_address_and_is_silent() {
    let mut bus = Bus::claimed(Variant::J1939);
    for address in 128..=247 {
        bus.hear_claim(address, better());
    }
    bus.run(160);
    let said = bus.sent.clone();
    assert_eq!(said.len(), 1, "{said:?}");
    assert_eq!(
        said[0].frame.extended_data_id().unwrap().as_raw(),
        0x18EE_FFFE
    );
    assert_eq!(said[0].data(), name(1).to_bytes());
    bus.run(3_000);
    assert_eq!(bus.sent.len(), 1);
    bus.ask(Pgn::ADDRESS_CLAIMED, 0xFF);
    bus.run(160);
    assert_eq!(bus.sent.len(), 2, "asked, it says so again");
    assert_eq!(bus.sent[1].id.source, 0xFE);
    assert_eq!(bus.node.address(), None);
}

#[test]
fn a_node_that_isnt_self_configurable_gives_up_at_once() {
    let mut bus = Bus::new(Variant::Iso11783);
    let fields = NameFields {
        self_configurable: false,
        ..NameFields::rear_hitch(9)
    };
    bus.node = Node::new(Settings {
        name: fields.into(),
        preferred_address: OURS,
        variant: Variant::Iso11783,
        occurrences: [0; KINDS],
        software: b"",
    });
    bus.run(300);
    bus.sent.clear();
    bus.hear_claim(OURS, Name(1));
    bus.run(500);
    assert_eq!(bus.sent.len(), 1);
    assert_eq!(bus.sent[0].id.source, 0xFE);
}

#[test]
fn losers_wait_differently_long() {
    // "Cannot claim" of two losers would collide if both sent it at once: both have the same identifier.
    let delay_ms = |serial: u32| {
        let mut bus = Bus::new(Variant::Iso11783);
        let fields = NameFields {
            self_configurable: false,
            ..NameFields::rear_hitch(serial)
        };
        bus.node = Node::new(Settings {
            name: fields.into(),
            preferred_address: OURS,
            variant: Variant::Iso11783,
            occurrences: [0; KINDS],
            software: b"",
        });
        bus.run(300);
        bus.sent.clear();
        bus.hear_claim(OURS, Name(1));
        let start = bus.now_ms;
        bus.run(160);
        bus.sent[0].at_ms.wrapping_sub(start)
    };
    let delays: Vec<u32> = [3, 60, 150].map(delay_ms).to_vec();
    assert!(delays.iter().all(|&delay| delay <= 153));
    assert!(delays[0] != delays[1] && delays[1] != delays[2]);
}

#[test]
fn an_echo_of_our_own_claim_is_no_contender() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.hear_claim(OURS, name(1));
    bus.run(50);
    assert_eq!(bus.node.address(), Some(OURS));
    assert!(bus.take(Pgn::ADDRESS_CLAIMED).is_empty());
}

#[test]
fn who_uses_our_address_is_reminded_once_in_five_seconds() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(6_000);
    bus.sent.clear();
    for _ in 0..10_000 {
        bus.receive(Pgn(0xFEF1), 0xFF, OURS, &[0; 8]);
        bus.step();
    }
    assert_eq!(bus.take(Pgn::ADDRESS_CLAIMED).len(), 2);
}

#[test]
fn a_node_that_babbles_claims_isnt_joined() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for _ in 0..1_000 {
        bus.hear_claim(OURS, worse());
        bus.hear_claim(OURS, worse());
        bus.step();
    }
    let answers = bus.take(Pgn::ADDRESS_CLAIMED).len();
    assert!((100..=200).contains(&answers), "{answers} in a second");
}

#[test]
fn contenders_dont_prolong_the_silence() {
    let mut bus = Bus::new(Variant::Iso11783);
    for _ in 0..252 {
        bus.hear_claim(OURS, worse());
        bus.step();
    }
    assert_eq!(bus.node.address(), Some(OURS));
}

#[test]
fn what_was_begun_under_an_address_ends_with_it() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    let troubles = [Trouble::SupplyLow, Trouble::LeverMissing];
    troubles
        .iter()
        .for_each(|&trouble| bus.status.troubles.insert(trouble));
    bus.step();
    bus.ask(Pgn(0xFEE5), OURS);
    bus.hear_claim(OURS, better());
    bus.sent.clear();
    bus.run(300);
    let packet = |sent: &Sent| sent.id.pgn == Pgn::TRANSPORT_DATA;
    assert!(
        !bus.sent.iter().any(packet),
        "of a message that was announced before"
    );
    let refused = |sent: &Sent| sent.id.pgn == Pgn::ACKNOWLEDGEMENT;
    assert!(
        !bus.sent.iter().any(refused),
        "who asked, asked another address"
    );
}
