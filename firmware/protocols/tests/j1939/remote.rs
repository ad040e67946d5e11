//! Status and remote control of the hitch.

use crate::bus::{Bus, OTHER, Sent};
use hitch_protocols::j1939::hitch::{Limit, StatusMessage};
use hitch_protocols::j1939::{ExitCode, HitchCommand, LimitStatus, Pgn, Remote, Variant};
use hitch_quantities::units::PerMille;

/// The raw value of the position that the hitch stands at.
const HERE: u8 = 155;

/// Commands every 100 ms, as an implement does.
fn commanded(bus: &mut Bus, wanted: HitchCommand, ms: u32) {
    for _ in 0..ms / 100 {
        bus.command(wanted);
        bus.run(100);
    }
}

fn last_status(bus: &Bus) -> StatusMessage {
    let mut statuses = bus.sent.iter().rev();
    let last = statuses.find(|sent| sent.id.pgn == Pgn::REAR_HITCH_STATUS);
    StatusMessage::from_bytes(last.unwrap().data().try_into().unwrap())
}

/// A bus on which an implement has the hitch.
fn remote_bus() -> Bus {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(100);
    bus.take_control(HERE);
    bus.run(100);
    assert_eq!(bus.node.remote(), Remote::Position(PerMille(620)));
    bus
}

fn periods(sent: &[Sent]) -> Vec<u32> {
    sent.windows(2)
        .map(|pair| pair[1].at_ms.wrapping_sub(pair[0].at_ms))
        .collect()
}

#[test]
fn the_status_comes_ten_times_a_second() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(2_000);
    let statuses = bus.take(Pgn::REAR_HITCH_STATUS);
    assert_eq!(periods(&statuses), vec![100; statuses.len() - 1]);
    assert_eq!(statuses.len(), 20);
    assert_eq!(
        statuses[0].frame.extended_data_id().unwrap().as_raw(),
        0x0CFE_4580
    );
}

#[test]
fn a_change_is_reported_within_20_ms_and_no_more_often() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(150);
    bus.sent.clear();
    let changed_ms = bus.now_ms;
    bus.status.exit = ExitCode::LockedOut;
    bus.run(1);
    assert_eq!(bus.sent[0].at_ms, changed_ms);
    assert_eq!(last_status(&bus).exit, ExitCode::LockedOut);
    // A hitch at full speed: another value every 8 ms.
    bus.sent.clear();
    for _ in 0..1_000 {
        let moved = bus.now_ms % 1_000;
        bus.status.position = Some(PerMille(i32::try_from(moved).unwrap()));
        bus.step();
    }
    let statuses = bus.take(Pgn::REAR_HITCH_STATUS);
    assert!(
        periods(&statuses)
            .iter()
            .all(|&period| (20..=30).contains(&period))
    );
}

#[test]
fn a_position_that_trembles_is_no_change() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for step in 0..2_000 {
        bus.status.position = Some(PerMille(620 + 4 * (step % 2)));
        bus.step();
    }
    assert_eq!(bus.take(Pgn::REAR_HITCH_STATUS).len(), 20);
}

#[test]
fn remote_control_starts_from_the_reported_position_only() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(100);
    for far in [HERE - 2, HERE + 2, 0, 250] {
        commanded(&mut bus, HitchCommand::Position(far), 300);
        assert_eq!(bus.node.remote_state(), 0, "{far}");
        assert_eq!(last_status(&bus).limit, LimitStatus::OperatorLimited);
    }
    bus.take_control(HERE);
    bus.run(100);
    assert_eq!(
        last_status(&bus).limit,
        LimitStatus::NotLimited,
        "the answer"
    );
    commanded(&mut bus, HitchCommand::Position(25), 200);
    assert_eq!(
        bus.node.remote(),
        Remote::Position(PerMille(100)),
        "then any"
    );
}

// REQ-MODE-11
#[test]
fn an_operator_who_does_something_else_ends_it() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.status.remote_permitted = false;
    bus.run(100);
    commanded(&mut bus, HitchCommand::Position(HERE), 300);
    assert_eq!(bus.node.remote_state(), 0);

    let mut bus = remote_bus();
    bus.status.remote_permitted = false;
    bus.run(1);
    assert_eq!(bus.node.remote(), Remote::Idle);
    assert_eq!(last_status(&bus).exit, ExitCode::OperatorOverride);
}

#[test]
fn a_hitch_whose_position_isnt_known_cant_be_commanded() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.status.position = None;
    bus.run(100);
    for raw in 0..=255 {
        bus.receive(
            Pgn::HITCH_COMMANDS,
            0xFF,
            OTHER,
            &[0xFF, raw, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF],
        );
        assert_eq!(bus.node.remote(), Remote::Idle, "{raw}");
    }
}

// REQ-MODE-11
#[test]
fn silence_ends_it_after_300_ms_with_its_reason() {
    let mut bus = remote_bus();
    // The last command is 100 ms old; 300 ms are borne.
    bus.run(201);
    assert_ne!(bus.node.remote(), Remote::Idle);
    bus.run(1);
    assert_eq!(bus.node.remote(), Remote::Idle);
    bus.run(20);
    assert_eq!(last_status(&bus).exit, ExitCode::Timeout);
    bus.take_control(HERE);
    bus.run(100);
    assert_eq!(
        last_status(&bus).exit,
        ExitCode::Clear,
        "a new start clears it"
    );
}

#[test]
fn the_lock_that_follows_doesnt_hide_the_reason_but_a_fault_does() {
    let mut bus = remote_bus();
    bus.run(300);
    bus.status.exit = ExitCode::LockedOut;
    bus.status.remote_permitted = false;
    bus.run(1_900);
    assert_eq!(last_status(&bus).exit, ExitCode::Timeout);
    bus.run(200);
    assert_eq!(last_status(&bus).exit, ExitCode::LockedOut, "in the end");
    let mut bus = remote_bus();
    bus.run(300);
    bus.status.exit = ExitCode::FunctionFault;
    bus.run(100);
    assert_eq!(last_status(&bus).exit, ExitCode::FunctionFault);
}

#[test]
fn the_reason_comes_before_the_lock_for_two_seconds() {
    let mut bus = remote_bus();
    bus.run(201);
    bus.status.exit = ExitCode::LockedOut;
    let ended_ms = bus.now_ms;
    bus.run(2_500);
    let statuses = bus.take(Pgn::REAR_HITCH_STATUS);
    let locked = statuses.iter().find(|sent| {
        let message = StatusMessage::from_bytes(sent.data().try_into().unwrap());
        sent.at_ms.wrapping_sub(ended_ms) < 3_000 && message.exit == ExitCode::LockedOut
    });
    let after_ms = locked.unwrap().at_ms.wrapping_sub(ended_ms);
    assert_eq!(after_ms, 2_000);
}

#[test]
fn a_command_out_of_range_is_answered_with_its_reason_if_commands_are_permitted() {
    for (permitted, exit) in [(true, ExitCode::OutOfRange), (false, ExitCode::Clear)] {
        let mut bus = Bus::claimed(Variant::Iso11783);
        bus.status.remote_permitted = permitted;
        bus.run(100);
        commanded(&mut bus, HitchCommand::OutOfRange, 100);
        assert_eq!(bus.node.remote(), Remote::Idle);
        assert_eq!(last_status(&bus).exit, exit, "permitted: {permitted}");
    }
}

#[test]
fn the_same_value_may_be_off_by_one_bit() {
    for (raw, position) in [(HERE - 1, 616), (HERE, 620), (HERE + 1, 624)] {
        let mut bus = Bus::claimed(Variant::Iso11783);
        bus.run(100);
        bus.take_control(raw);
        assert_eq!(bus.node.remote(), Remote::Position(PerMille(position)));
    }
}

#[test]
fn all_ones_give_back_and_reserved_values_end_it() {
    let mut bus = remote_bus();
    commanded(&mut bus, HitchCommand::None, 100);
    assert_eq!(bus.node.remote(), Remote::Idle);
    assert_eq!(last_status(&bus).exit, ExitCode::Released);

    let mut bus = remote_bus();
    commanded(&mut bus, HitchCommand::OutOfRange, 100);
    assert_eq!(bus.node.remote(), Remote::Idle);
    assert_eq!(last_status(&bus).exit, ExitCode::OutOfRange);
}

#[test]
fn limits_are_reported_and_the_command_stays() {
    let mut bus = remote_bus();
    for (limit, status) in [
        (Limit::High, LimitStatus::LimitedHigh),
        (Limit::Low, LimitStatus::LimitedLow),
        (Limit::None, LimitStatus::NotLimited),
        (Limit::NonRecoverable, LimitStatus::NonRecoverable),
    ] {
        bus.status.limit = limit;
        commanded(&mut bus, HitchCommand::Position(200), 100);
        assert_eq!(last_status(&bus).limit, status);
        assert_eq!(bus.node.remote(), Remote::Position(PerMille(800)));
    }
}

/// A hitch that a fault holds says so to every node, not only to the one that commands it.
#[test]
fn a_fault_is_reported_whether_or_not_a_node_is_in_control() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(100);
    assert_eq!(last_status(&bus).limit, LimitStatus::OperatorLimited);
    bus.status.limit = Limit::NonRecoverable;
    bus.run(100);
    assert_eq!(bus.node.remote(), Remote::Idle);
    assert_eq!(last_status(&bus).limit, LimitStatus::NonRecoverable);
}

#[test]
fn only_the_node_that_took_control_is_heard() {
    let mut bus = remote_bus();
    for _ in 0..20 {
        bus.receive(
            Pgn::HITCH_COMMANDS,
            0xFF,
            0x27,
            &HitchCommand::Position(10).to_bytes(),
        );
        bus.receive(
            Pgn::HITCH_COMMANDS,
            0xFF,
            0x27,
            &HitchCommand::None.to_bytes(),
        );
        bus.receive(
            Pgn::HITCH_COMMANDS,
            0xFF,
            0xFE,
            &HitchCommand::None.to_bytes(),
        );
        bus.run(10);
    }
    assert_eq!(bus.node.remote(), Remote::Position(PerMille(620)));
    bus.run(101);
    assert_eq!(
        bus.node.remote(),
        Remote::Idle,
        "others don't keep it alive"
    );
}

#[test]
fn duplicated_and_malformed_commands_change_nothing() {
    let mut bus = remote_bus();
    for _ in 0..5 {
        bus.command(HitchCommand::Position(HERE));
    }
    for length in 0..8 {
        bus.receive(Pgn::HITCH_COMMANDS, 0xFF, OTHER, &vec![0; length]);
    }
    assert_eq!(bus.node.remote(), Remote::Position(PerMille(620)));
}

#[test]
fn a_node_without_an_address_commands_nothing() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(100);
    for source in [0xFE, 0xFF] {
        let command = HitchCommand::Position(HERE).to_bytes();
        bus.receive(Pgn::HITCH_COMMANDS, 0xFF, source, &command);
        assert_eq!(bus.node.remote_state(), 0, "{source:X}");
    }
}
