//! A full bus, nonsense on it, and nodes that never stop: what the hitch does stays the same and stays bounded.

use hitch_protocols::can::{ExtendedId, Frame};
use hitch_protocols::j1939::{Pgn, Remote, Variant};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::bus::{Bus, OTHER, OURS, name};

/// The shortest extended frame has 67 bits: at 250 kbit/s not quite four fit into a millisecond.
const FULL_LOAD_PER_MS: usize = 4;
/// What a node may put on the bus in a millisecond: one of each kind that has a spacing of its own.
const MOST_PER_MS: usize = 5;

fn frame() -> impl Strategy<Value = Frame> {
    // Half of them look like something that the node knows.
    let groups = prop::sample::select(vec![
        Pgn::REQUEST,
        Pgn::ADDRESS_CLAIMED,
        Pgn::TRANSPORT_CONNECTION,
        Pgn::TRANSPORT_DATA,
        Pgn::HITCH_COMMANDS,
        Pgn::ACKNOWLEDGEMENT,
    ]);
    let near = (
        groups,
        prop::sample::select(vec![OURS, 0xFF, OTHER]),
        any::<u8>(),
    )
        .prop_map(|(group, destination, source)| {
            let specific = if group.has_destination() {
                u32::from(destination) << 8
            } else {
                0
            };
            0x1800_0000 | (group.0 << 8) | specific | u32::from(source)
        });
    let raw = prop_oneof![near, 0..0x2000_0000_u32];
    let first = prop::sample::select(vec![16, 17, 19, 32, 255, 0xCA, 0xCB, 0x00]);
    let data = (first, prop::collection::vec(any::<u8>(), 0..8)).prop_map(|(first, mut rest)| {
        rest.insert(0, first);
        rest
    });
    (raw, data).prop_map(|(raw, data)| {
        Frame::data_frame(ExtendedId::new(raw).unwrap().into(), &data).unwrap()
    })
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(1), ..ProptestConfig::with_cases(200) })]

    // REQ-SAFE-08
    #[test]
    fn whatever_is_on_the_bus_the_node_goes_on(frames in prop::collection::vec(frame(), 400)) {
        let mut bus = Bus::claimed(Variant::J1939);
        for burst in frames.chunks(FULL_LOAD_PER_MS) {
            for frame in burst {
                bus.node.receive(frame, bus.now_ms);
            }
            prop_assert!(bus.step() <= MOST_PER_MS);
        }
        // Once it is quiet, the node has an address or says that it can't have one, and reports again.
        bus.run(600);
        bus.sent.clear();
        bus.run(101);
        if bus.node.address().is_some() {
            prop_assert!(!bus.take(Pgn::REAR_HITCH_STATUS).is_empty());
        }
    }
}

#[test]
fn a_node_that_asks_without_end_gets_a_bounded_answer() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for round in 0..2_000_u32 {
        for more in 0..4 {
            bus.ask(Pgn(0xFE00 + (round * 4 + more) % 256), OURS);
        }
        bus.step();
    }
    let statuses = bus
        .sent
        .iter()
        .filter(|sent| sent.id.pgn == Pgn::REAR_HITCH_STATUS)
        .count();
    assert!(
        statuses >= 20,
        "the status keeps its rhythm: {statuses} in 2 s"
    );
    assert!(bus.sent.len() <= 500, "{} frames in 2 s", bus.sent.len());
}

#[test]
fn a_full_bus_of_others_traffic_doesnt_delay_the_status() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    let other = ExtendedId::new(0x0CF0_0400).unwrap();
    let traffic = Frame::of_eight(other, [0; 8]);
    for _ in 0..2_000 {
        for _ in 0..FULL_LOAD_PER_MS {
            bus.node.receive(&traffic, bus.now_ms);
        }
        bus.step();
    }
    let statuses = bus.take(Pgn::REAR_HITCH_STATUS);
    for pair in statuses.windows(2) {
        assert_eq!(pair[1].at_ms.wrapping_sub(pair[0].at_ms), 100);
    }
}

#[test]
fn a_storm_of_claims_leaves_no_remote_control_behind() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for round in 0..1_000_u32 {
        bus.hear_claim(OURS, name(2 + round));
        bus.hear_claim(u8::try_from(round % 253).unwrap(), name(0));
        bus.step();
    }
    assert_eq!(bus.node.remote(), Remote::Idle);
    bus.run(500);
    let source = bus.node.address();
    assert!(source.is_none(), "every address is taken by a better NAME");
}
