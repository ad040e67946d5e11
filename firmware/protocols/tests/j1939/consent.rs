//! The operator's consent to remote control, who may ask for it, and what ends it with which reason.

use std::collections::HashSet;

use hitch_protocols::j1939::hitch::StatusMessage;
use hitch_protocols::j1939::remote::{CONSENT_MS, TRANSFER_MS};
use hitch_protocols::j1939::{
    ExitCode, HitchCommand, LimitStatus, Name, NameFields, Pgn, Remote, Variant,
};
use hitch_quantities::calibration::design_parameters::RemoteParameters;
use hitch_quantities::units::{Count, MicrometrePerSecond, PerMille};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::bus::{Bus, OTHER, OURS, implement, name};

/// The raw value of the position that the hitch stands at.
const HERE: HitchCommand = HitchCommand::Position(155);
const ACTIVE: Remote = Remote::Position(PerMille(620));

fn bus() -> Bus {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(100);
    bus
}

fn active() -> Bus {
    let mut bus = bus();
    bus.take_control(155);
    assert_eq!(bus.node.remote(), ACTIVE);
    bus.run(100);
    bus
}

/// The exit code of the next status.
fn exit(bus: &mut Bus) -> ExitCode {
    bus.sent.clear();
    bus.run(101);
    let statuses = bus.take(Pgn::REAR_HITCH_STATUS);
    let last = statuses.last().unwrap().data().try_into().unwrap();
    StatusMessage::from_bytes(last).exit
}

/// Commands every 100 ms.
fn commanded(bus: &mut Bus, source: u8, ms: u32) {
    for _ in 0..ms / 100 {
        bus.command_from(source, HERE);
        bus.run(100);
    }
}

// REQ-MODE-11
#[test]
fn a_request_waits_ten_seconds_for_consent() {
    let mut waiting = bus();
    commanded(&mut waiting, OTHER, CONSENT_MS - 100);
    assert_eq!(waiting.node.remote_state(), 1);
    assert_eq!(exit(&mut waiting), ExitCode::NoOperator);
    let mut late = bus();
    commanded(&mut late, OTHER, CONSENT_MS + 100);
    assert_eq!(late.node.remote_state(), 0);
    assert_eq!(exit(&mut late), ExitCode::NoOperator);
    // Nor does consent count later, as long as the implement doesn't ask anew.
    commanded(&mut late, OTHER, 1_000);
    late.consent();
    commanded(&mut late, OTHER, 1_000);
    assert_eq!(late.node.remote_state(), 0);
    late.run(400);
    late.take_control(155);
}

// REQ-MODE-11
#[test]
fn consent_counts_for_the_request_that_is_under_way() {
    let mut bus = bus();
    bus.consent();
    bus.run(50);
    commanded(&mut bus, OTHER, 2_000);
    assert_eq!(bus.node.remote_state(), 1, "given before the request");
    bus.consent();
    assert_eq!(bus.node.remote_state(), 2);
    assert_eq!(bus.node.remote(), Remote::Idle);
    bus.command(HERE);
    assert_eq!(bus.node.remote(), ACTIVE);
}

// REQ-MODE-11
#[test]
fn consent_has_to_be_used_from_the_reported_position() {
    let mut bus = bus();
    commanded(&mut bus, OTHER, 200);
    bus.consent();
    for _ in 0..TRANSFER_MS / 100 {
        bus.command(HitchCommand::Position(100));
        assert_eq!(bus.node.remote_state(), 2);
        bus.run(100);
    }
    assert_eq!(bus.node.remote_state(), 0);
    assert_eq!(exit(&mut bus), ExitCode::Timeout);
}

/// Fields of an implement that is entitled to ask.
fn entitled() -> NameFields {
    NameFields {
        function: 128,
        device_class: 6,
        ..NameFields::rear_hitch(5_000)
    }
}

// REQ-MODE-11
#[test]
fn only_an_implement_with_a_claimed_address_asks() {
    let mut unknown = bus();
    commanded(&mut unknown, 0x27, 1_000);
    assert_eq!(unknown.node.remote_state(), 0, "no claim");
    let class = |device_class| NameFields {
        device_class,
        ..entitled()
    };
    let group = |industry_group| NameFields {
        industry_group,
        ..entitled()
    };
    for (fields, expected) in [
        (entitled(), 1),
        (class(0), 0),
        (class(1), 0),
        (class(2), 1),
        (class(126), 1),
        (class(127), 0),
        (group(0), 0),
        (group(1), 0),
        (group(3), 0),
        (group(5), 0),
    ] {
        let mut bus = bus();
        bus.hear_claim(0x27, fields.into());
        commanded(&mut bus, 0x27, 300);
        assert_eq!(bus.node.remote_state(), expected, "{fields:?}");
    }
}

#[test]
fn an_unknown_sender_is_asked_for_its_claim_once_a_second() {
    let mut bus = bus();
    bus.sent.clear();
    commanded(&mut bus, 0x27, 4_500);
    let requests = bus.take(Pgn::REQUEST);
    assert!((4..=5).contains(&requests.len()), "{}", requests.len());
    assert_eq!(requests[0].id.destination, 0x27);
    assert_eq!(requests[0].data(), [0x00, 0xEE, 0x00]);
    bus.hear_claim(0x27, implement(7));
    commanded(&mut bus, 0x27, 100);
    assert_eq!(bus.node.remote_state(), 1);
    commanded(&mut bus, 0x27, 2_000);
    assert!(bus.take(Pgn::REQUEST).is_empty(), "known");
}

// REQ-MODE-11
#[test]
fn a_changed_or_contended_claim_of_the_sender_ends_it() {
    let lower = implement(0);
    for (address, other, ends) in [
        (OTHER, implement(1), false),
        (OTHER, implement(2), true),
        (OTHER, lower, true),
        (0x27, implement(1), true),
        (0xFE, implement(1), true),
        (0x27, implement(2), false),
        (0xFE, implement(2), false),
    ] {
        let mut bus = active();
        bus.hear_claim(address, other);
        let expected = if ends { Remote::Idle } else { ACTIVE };
        assert_eq!(bus.node.remote(), expected, "{address:X} {other:?}");
        if ends {
            assert_eq!(exit(&mut bus), ExitCode::Error);
        }
    }
}

// REQ-MODE-11
#[test]
fn it_ends_with_the_own_address() {
    let mut bus = active();
    // A NAME of a higher priority.
    bus.hear_claim(OURS, Name(1));
    bus.step();
    assert_eq!(bus.node.remote(), Remote::Idle);
    commanded(&mut bus, OTHER, 400);
    assert_eq!(bus.node.remote_state(), 0);
    assert_eq!(exit(&mut bus), ExitCode::Error, "at the next address");

    let mut bus = bus_without_address();
    commanded(&mut bus, OTHER, 1_000);
    assert_eq!(bus.node.remote_state(), 0);
}

/// A bus whose addresses have all been claimed by better NAMEs.
fn bus_without_address() -> Bus {
    let mut bus = bus();
    for address in 128..=247 {
        bus.hear_claim(address, Name(u64::from(address)));
    }
    bus.run(500);
    assert_eq!(bus.node.address(), None);
    bus
}

// REQ-MODE-11
#[test]
fn two_set_points_within_a_period_come_from_two_senders() {
    for (after_ms, ends) in [(0, true), (30, true), (59, true), (60, false), (100, false)] {
        let mut bus = active();
        bus.command(HERE);
        bus.run(after_ms);
        bus.command(HitchCommand::Position(200));
        let expected = if ends {
            Remote::Idle
        } else {
            Remote::Position(PerMille(800))
        };
        assert_eq!(bus.node.remote(), expected, "{after_ms} ms");
        if ends {
            assert_eq!(exit(&mut bus), ExitCode::Error);
        }
    }
}

fn speed_message(mm_per_s: u16) -> [u8; 8] {
    let [low, high] = mm_per_s.to_le_bytes();
    [low, high, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF]
}

// REQ-MODE-11
#[test]
fn a_ground_speed_above_the_limit_ends_and_refuses_it() {
    for group in [Pgn::WHEEL_SPEED, Pgn::GROUND_SPEED] {
        for (mm_per_s, ends) in [
            (4_167, false),
            (4_168, true),
            (64_255, true),
            (64_256, false),
        ] {
            let mut bus = active();
            bus.receive(group, 0xFF, 0x01, &speed_message(mm_per_s));
            bus.step();
            let expected = if ends { Remote::Idle } else { ACTIVE };
            assert_eq!(bus.node.remote(), expected, "{mm_per_s}");
        }
        let mut bus = active();
        bus.receive(group, 0xFF, 0x01, &speed_message(5_000));
        // A slow one of another node doesn't hide it.
        bus.receive(group, 0xFF, 0x02, &speed_message(0));
        assert_eq!(exit(&mut bus), ExitCode::SpeedTooHigh);
        bus.command(HitchCommand::None);
        bus.command(HERE);
        assert_eq!(bus.node.remote_state(), 0, "still");
        bus.run(201);
        bus.command(HERE);
        assert_eq!(bus.node.remote_state(), 1);
    }
    let mut bus = active();
    bus.node.bound_remote_control(RemoteParameters {
        ground_speed: MicrometrePerSecond(1_000_000),
        ..RemoteParameters::NOMINAL
    });
    bus.receive(Pgn::WHEEL_SPEED, 0xFF, 0x01, &speed_message(1_001));
    bus.step();
    assert_eq!(bus.node.remote(), Remote::Idle);
}

// REQ-MODE-11
#[test]
fn the_range_bounds_the_set_point_and_the_start() {
    let bounds = RemoteParameters {
        lowest: PerMille(400),
        highest: PerMille(700),
        ..RemoteParameters::NOMINAL
    };
    let mut bus = active();
    bus.node.bound_remote_control(bounds);
    for (raw, position, limit) in [
        (100, 400, LimitStatus::NotLimited),
        (99, 400, LimitStatus::LimitedLow),
        (0, 400, LimitStatus::LimitedLow),
        (175, 700, LimitStatus::NotLimited),
        (176, 700, LimitStatus::LimitedHigh),
        (250, 700, LimitStatus::LimitedHigh),
    ] {
        bus.command(HitchCommand::Position(raw));
        assert_eq!(bus.node.remote(), Remote::Position(PerMille(position)));
        bus.sent.clear();
        bus.run(101);
        let statuses = bus.take(Pgn::REAR_HITCH_STATUS);
        let last = statuses.last().unwrap().data().try_into().unwrap();
        assert_eq!(StatusMessage::from_bytes(last).limit, limit, "{raw}");
    }
    for (highest, state) in [(620, 1), (619, 0)] {
        let mut bus = crate::consent::bus();
        bus.node.bound_remote_control(RemoteParameters {
            highest: PerMille(highest),
            ..bounds
        });
        bus.command(HERE);
        assert_eq!(bus.node.remote_state(), state);
        let expected = [ExitCode::OutOfRange, ExitCode::NoOperator];
        assert_eq!(exit(&mut bus), expected[usize::from(state)]);
    }
}

// REQ-MODE-11
#[test]
fn it_is_refused_where_it_is_not_offered() {
    let none = RemoteParameters {
        consent: Count(0),
        ..RemoteParameters::NOMINAL
    };
    let mut bus = bus();
    bus.node.bound_remote_control(none);
    commanded(&mut bus, OTHER, 300);
    bus.consent();
    commanded(&mut bus, OTHER, 300);
    assert_eq!(bus.node.remote_state(), 0);
    assert_eq!(exit(&mut bus), ExitCode::NotCalibrated);
    let mut bus = active();
    bus.node.bound_remote_control(none);
    bus.step();
    assert_eq!(bus.node.remote(), Remote::Idle);
}

// REQ-MODE-11
#[test]
fn a_sender_whose_control_has_ended_pauses_before_it_asks_again() {
    for ms in [300, 302] {
        let mut bus = active();
        bus.status.remote_permitted = false;
        bus.step();
        bus.status.remote_permitted = true;
        commanded(&mut bus, OTHER, 1_000);
        assert_eq!(bus.node.remote_state(), 0, "it has gone on");
        bus.run(ms - 100);
        bus.command(HERE);
        assert_eq!(bus.node.remote_state(), u8::from(ms > 301), "{ms}");
    }
    let mut bus = active();
    bus.status.remote_permitted = false;
    bus.step();
    bus.status.remote_permitted = true;
    bus.step();
    bus.hear_claim(0x27, implement(7));
    bus.command_from(0x27, HERE);
    assert_eq!(bus.node.remote_state(), 1, "another one may");
}

// REQ-MODE-11
#[test]
fn nothing_of_a_request_moves_the_hitch_when_the_node_next_to_it_asks() {
    let mut bus = bus();
    bus.hear_claim(0x27, implement(7));
    commanded(&mut bus, OTHER, 200);
    bus.command_from(0x27, HERE);
    bus.consent();
    bus.command_from(0x27, HERE);
    assert_eq!(
        bus.node.remote(),
        Remote::Idle,
        "consent is the first one's"
    );
    bus.command(HERE);
    assert_eq!(bus.node.remote(), ACTIVE);
}

#[test]
fn a_node_has_one_name_for_each_address() {
    let names: HashSet<u64> = [implement(1).0, implement(2).0, name(1).0].into();
    assert_eq!(names.len(), 3);
}

/// A message of anybody, mostly one that matters for remote control.
fn message() -> impl Strategy<Value = (Pgn, u8, [u8; 8])> {
    let sources = prop::sample::select(vec![OTHER, 0x27, OURS, 0, 0xFE, 0xFF, 0x81]);
    let command = prop::sample::select(vec![153_u8, 154, 155, 156, 157, 200, 0, 250, 254, 255])
        .prop_map(|raw| {
            (
                Pgn::HITCH_COMMANDS,
                [0xFF, raw, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF],
            )
        });
    let claim = prop::sample::select(vec![implement(1), implement(2), name(1), Name(1)])
        .prop_map(|name| (Pgn::ADDRESS_CLAIMED, name.to_bytes()));
    let speed = any::<u16>().prop_map(|speed| (Pgn::WHEEL_SPEED, speed_message(speed)));
    let any_group = (0..0x3_FFFF_u32, any::<[u8; 8]>()).prop_map(|(pgn, bytes)| (Pgn(pgn), bytes));
    let kinds = prop_oneof![6 => command, 2 => claim, 1 => speed, 2 => any_group];
    (kinds, sources).prop_map(|((pgn, bytes), source)| (pgn, source, bytes))
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(2), ..ProptestConfig::with_cases(200) })]

    // REQ-MODE-11
    #[test]
    fn no_bus_traffic_without_consent_commands_the_hitch(
        messages in prop::collection::vec((message(), 0..120_u32), 300)
    ) {
        let mut bus = bus();
        for ((pgn, source, bytes), wait_ms) in messages {
            bus.receive(pgn, 0xFF, source, &bytes);
            prop_assert!(bus.node.remote_state() < 2);
            bus.run(wait_ms);
            prop_assert_eq!(bus.node.remote(), Remote::Idle);
        }
    }

    // REQ-MODE-11
    #[test]
    fn whoever_has_the_hitch_is_an_implement_inside_its_bounds(
        messages in prop::collection::vec((message(), 0..120_u32, any::<bool>()), 300)
    ) {
        let mut bus = bus();
        for ((pgn, source, bytes), wait_ms, consents) in messages {
            let before = bus.node.remote_state();
            bus.receive(pgn, 0xFF, source, &bytes);
            let after = bus.node.remote_state();
            prop_assert!(after != 3 || before >= 2, "by way of consent");
            if consents {
                bus.consent();
            }
            bus.run(wait_ms);
            if let Remote::Position(position) = bus.node.remote() {
                prop_assert!((0..=880).contains(&position.0));
                prop_assert!(bus.node.address().is_some());
            }
        }
    }
}
