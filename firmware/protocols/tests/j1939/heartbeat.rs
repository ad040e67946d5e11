//! Heartbeats, the node's own and an implement's.

use hitch_protocols::j1939::hitch::StatusMessage;
use hitch_protocols::j1939::{ExitCode, HitchCommand, Pgn, Remote, Variant};
use hitch_quantities::units::PerMille;

use crate::bus::{Bus, OTHER, OURS};

const HERE: u8 = 155;
const ACTIVE: Remote = Remote::Position(PerMille(620));

fn beat(bus: &mut Bus, number: u8) {
    bus.receive(Pgn::HEARTBEAT, 0xFF, OTHER, &[number]);
}

/// Commands every 100 ms, with these heartbeats.
fn commanded(bus: &mut Bus, beats: impl IntoIterator<Item = u8>) {
    for number in beats {
        beat(bus, number);
        command(bus, 1);
    }
}

fn command(bus: &mut Bus, times: u32) {
    for _ in 0..times {
        bus.command(HitchCommand::Position(HERE));
        bus.run(100);
    }
}

/// Commands every 100 ms with these heartbeats, of an implement that begins anew, and the operator consents.
fn begin_anew(bus: &mut Bus, beats: impl IntoIterator<Item = u8>) {
    bus.command(HitchCommand::None);
    for number in beats {
        beat(bus, number);
        bus.command(HitchCommand::Position(HERE));
        bus.consent();
        bus.run(99);
    }
}

fn exit(bus: &mut Bus) -> ExitCode {
    let statuses = bus.take(Pgn::REAR_HITCH_STATUS);
    let last = statuses.last().unwrap().data().try_into().unwrap();
    StatusMessage::from_bytes(last).exit
}

/// A bus on which an implement has the hitch and has sent 251, 0, ... 9.
fn watched() -> Bus {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(100);
    begin_anew(&mut bus, [251].into_iter().chain(0..10));
    assert_eq!(bus.node.remote(), ACTIVE);
    bus
}

#[test]
fn who_asks_gets_it_every_100_ms() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(500);
    assert!(bus.take(Pgn::HEARTBEAT).is_empty());
    let request = [0xE4, 0xF0, 0, 100, 0, 0xFF, 0xFF, 0xFF];
    bus.receive(Pgn::REPETITION_RATE, OURS, OTHER, &request);
    bus.run(26_000);
    let beats = bus.take(Pgn::HEARTBEAT);
    let gaps = beats
        .windows(2)
        .map(|pair| pair[1].at_ms.wrapping_sub(pair[0].at_ms));
    assert!(gaps.into_iter().all(|gap_ms| gap_ms == 100));
    let numbers: Vec<u8> = beats.iter().flat_map(|sent| sent.data().to_vec()).collect();
    let expected = [251].into_iter().chain(0..=250).chain(0..=7);
    assert_eq!(numbers, expected.collect::<Vec<u8>>());
    // A group that isn't repeated.
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.receive(
        Pgn::REPETITION_RATE,
        OURS,
        OTHER,
        &[0xCA, 0xFE, 0, 100, 0, 0xFF, 0xFF, 0xFF],
    );
    bus.run(500);
    assert!(bus.take(Pgn::HEARTBEAT).is_empty());
}

#[test]
fn who_takes_the_hitch_is_asked_for_one_and_may_have_none() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(100);
    command(&mut bus, 1);
    bus.consent();
    command(&mut bus, 20);
    assert_eq!(bus.node.remote(), ACTIVE);
    let asked = bus.take(Pgn::REPETITION_RATE);
    assert_eq!(asked.len(), 1);
    assert_eq!(asked[0].id.destination, OTHER);
    assert_eq!(asked[0].data(), [0xE4, 0xF0, 0, 100, 0, 0xFF, 0xFF, 0xFF]);
}

// REQ-MODE-11
#[test]
fn a_heartbeat_that_goes_wrong_ends_remote_control_until_eight_are_good() {
    // The same again, too far on, backwards, the sender's own "broken", and a reserved value.
    for wrong in [9, 13, 8, 254, 252] {
        let mut bus = watched();
        commanded(&mut bus, [wrong]);
        assert_eq!(bus.node.remote(), Remote::Idle, "{wrong}");
        assert_eq!(exit(&mut bus), ExitCode::Timeout);
        // The first of these is measured against the wrong one.
        begin_anew(&mut bus, 100..108);
        assert_eq!(bus.node.remote_state(), 0, "seven good ones");
        begin_anew(&mut bus, 108..111);
        assert_eq!(bus.node.remote(), ACTIVE, "ten");
    }
}

#[test]
fn one_that_is_lost_or_goes_round_is_forgiven() {
    let mut bus = watched();
    commanded(&mut bus, [12, 15]);
    assert_eq!(bus.node.remote(), ACTIVE);
    commanded(&mut bus, (16..=250).chain([2, 3]));
    assert_eq!(bus.node.remote(), ACTIVE);
}

#[test]
fn silence_ends_remote_control_though_commands_go_on() {
    let mut bus = watched();
    command(&mut bus, 4);
    assert_eq!(bus.node.remote(), Remote::Idle);
    let asked = bus.take(Pgn::REPETITION_RATE);
    assert!(!asked.is_empty(), "asked for it again");
    command(&mut bus, 50);
    assert_eq!(bus.node.remote(), Remote::Idle);
    let asked = bus.take(Pgn::REPETITION_RATE);
    assert!(
        (4..=6).contains(&asked.len()),
        "{} times in 5 s",
        asked.len()
    );
    // Its sender begins anew.
    begin_anew(&mut bus, [251].into_iter().chain(0..10));
    assert_eq!(bus.node.remote(), ACTIVE);
}

#[test]
fn one_that_stops_on_purpose_is_missed_by_nobody() {
    let mut bus = watched();
    beat(&mut bus, 255);
    command(&mut bus, 20);
    assert_eq!(bus.node.remote(), ACTIVE);
}
