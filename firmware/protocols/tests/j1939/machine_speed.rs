//! Speeds of the machine from the bus, for draft and slip control.

use crate::bus::{Bus, OTHER};
use hitch_protocols::j1939::{Node, Pgn, Variant};
use hitch_quantities::units::MillimetrePerSecond;

/// The tractor and a receiver of satellites.
const TRACTOR: u8 = 240;
const RECEIVER: u8 = 28;

type Take = fn(&mut Node) -> Option<MillimetrePerSecond>;

/// Both groups with what takes their speed.
const GROUPS: [(Pgn, Take); 2] = [
    (Pgn::GROUND_SPEED, Node::take_ground_speed),
    (Pgn::WHEEL_SPEED, Node::take_wheel_speed),
];

/// A message with a distance, and the direction forwards.
fn message(raw: u16) -> [u8; 8] {
    let [low, high] = raw.to_le_bytes();
    [low, high, 0x10, 0x27, 0, 0, 0xFF, 0b1111_1101]
}

fn heard(bus: &mut Bus, (pgn, take): (Pgn, Take), source: u8, raw: u16) -> Option<i32> {
    bus.receive(pgn, 0xFF, source, &message(raw));
    take(&mut bus.node).map(|MillimetrePerSecond(speed)| speed)
}

#[test]
fn a_speed_has_a_millimetre_per_second_a_bit_and_is_given_once() {
    for group in GROUPS {
        let mut bus = Bus::new(Variant::J1939);
        assert_eq!(group.1(&mut bus.node), None);
        for raw in [0, 1, 889, 1_800, 0xFAFF] {
            assert_eq!(heard(&mut bus, group, TRACTOR, raw), Some(i32::from(raw)));
            assert_eq!(group.1(&mut bus.node), None, "no second time");
        }
    }
}

#[test]
fn each_group_gives_its_own_speed() {
    let mut bus = Bus::new(Variant::J1939);
    bus.receive(Pgn::GROUND_SPEED, 0xFF, TRACTOR, &message(1_800));
    bus.receive(Pgn::WHEEL_SPEED, 0xFF, TRACTOR, &message(2_000));
    assert_eq!(
        bus.node.take_ground_speed(),
        Some(MillimetrePerSecond(1_800))
    );
    assert_eq!(
        bus.node.take_wheel_speed(),
        Some(MillimetrePerSecond(2_000))
    );
}

#[test]
fn reserved_values_errors_and_not_available_are_no_speed() {
    for group in GROUPS {
        for raw in [0xFB00, 0xFDFF, 0xFE00, 0xFEFF, 0xFF00, 0xFFFF] {
            let mut bus = Bus::new(Variant::J1939);
            assert_eq!(heard(&mut bus, group, TRACTOR, raw), None, "{raw:X}");
        }
    }
}

#[test]
fn of_two_senders_the_first_is_used_until_it_has_sent_no_speed_for_300_ms() {
    for group in GROUPS {
        let mut bus = Bus::new(Variant::J1939);
        // A tractor without a radar sends the group without a speed.
        assert_eq!(heard(&mut bus, group, TRACTOR, 0xFFFF), None);
        assert_eq!(heard(&mut bus, group, RECEIVER, 1_800), Some(1_800));
        assert_eq!(heard(&mut bus, group, OTHER, 900), None);
        bus.run(300);
        assert_eq!(heard(&mut bus, group, OTHER, 900), None);
        // What is not a speed does not keep it.
        assert_eq!(heard(&mut bus, group, RECEIVER, 0xFE00), None);
        bus.run(1);
        assert_eq!(heard(&mut bus, group, OTHER, 900), Some(900));
        assert_eq!(heard(&mut bus, group, RECEIVER, 1_800), None);
    }
}

#[test]
fn a_silent_sender_stays_silent_when_the_milliseconds_have_wrapped() {
    for group in GROUPS {
        let mut bus = Bus::new(Variant::J1939);
        assert_eq!(heard(&mut bus, group, TRACTOR, 1_800), Some(1_800));
        bus.run(302);
        bus.now_ms = bus.now_ms.wrapping_sub(302);
        assert_eq!(heard(&mut bus, group, RECEIVER, 900), Some(900));
    }
}
