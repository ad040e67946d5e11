//! Identifiers, NAMEs and hitch messages, against frames and tables of the standards.

use hitch_protocols::can::{ExtendedId, Frame};
use hitch_protocols::j1939::hitch::{StatusMessage, position, raw_position};
use hitch_protocols::j1939::{
    Draft, ExitCode, HitchCommand, HitchStatus, Id, InWork, LimitStatus, Name, NameFields, Pgn,
    Variant,
};
use hitch_quantities::units::{Millisecond, Newton, PerMille};

use crate::bus::Bus;

#[test]
fn identifiers_are_those_of_the_standard() {
    let known = [
        // Rear hitch status of 0x80, hitch commands of 0x26, a claim, a request to 0x80, XCP both ways.
        (0x0CFE_4580, (3, Pgn::REAR_HITCH_STATUS, 0xFF, 0x80)),
        (0x0CFE_4226, (3, Pgn::HITCH_COMMANDS, 0xFF, 0x26)),
        (0x18EE_FF80, (6, Pgn::ADDRESS_CLAIMED, 0xFF, 0x80)),
        (0x18EA_80F9, (6, Pgn::REQUEST, 0x80, 0xF9)),
        (0x18EF_80F9, (6, Pgn::PROPRIETARY_A, 0x80, 0xF9)),
        (0x18EF_F980, (6, Pgn::PROPRIETARY_A, 0xF9, 0x80)),
        (0x18FE_CA80, (6, Pgn::DM1, 0xFF, 0x80)),
        (0x1CEC_FF80, (7, Pgn::TRANSPORT_CONNECTION, 0xFF, 0x80)),
    ];
    for (raw, (priority, pgn, destination, source)) in known {
        let id = Id {
            priority,
            pgn,
            destination,
            source,
        };
        let packed = ExtendedId::new(raw).unwrap();
        assert_eq!(id.pack(), packed, "{raw:08X}");
        assert_eq!(Id::unpack(packed), id, "{raw:08X}");
    }
}

#[test]
fn every_identifier_survives_unpacking() {
    // Every bit on its own, and all of them.
    let raws = (0..29).map(|bit| 1 << bit).chain([0, 0x1FFF_FFFF]);
    for id in raws.filter_map(ExtendedId::new) {
        assert_eq!(Id::unpack(id).pack(), id, "{:08X}", id.as_raw());
    }
}

#[test]
fn the_fields_of_a_name_are_where_they_belong() {
    let fields = NameFields {
        identity: 0x1F_FFFF,
        manufacturer: 0,
        ecu_instance: 0b101,
        function_instance: 0,
        function: 130,
        device_class: 0,
        device_class_instance: 0b1001,
        industry_group: 2,
        self_configurable: true,
    };
    assert_eq!(Name::from(fields).0, 0xA900_8205_001F_FFFF);
    assert_eq!(
        Name::from(NameFields::rear_hitch(1)).0,
        0xA002_8200_0000_0001
    );
}

#[test]
fn the_reference_status_is_encoded_and_decoded() {
    // 62 %, in work, not limited, +60 % lower link force, 2550 N of draft, all clear.
    let bytes = [0x9B, 0x47, 0xC8, 0xFF, 0x7D, 0xC0, 0xFF, 0xFF];
    let message = StatusMessage {
        position: 155,
        in_work: InWork::Yes,
        limit: LimitStatus::NotLimited,
        lower_link_force: 200,
        draft: 32_255,
        exit: ExitCode::Clear,
    };
    assert_eq!(message.to_bytes(), bytes);
    assert_eq!(StatusMessage::from_bytes(&bytes), message);
}

#[test]
fn a_hitch_without_force_sensors_says_so() {
    let status = HitchStatus {
        position: Some(PerMille(620)),
        in_work: InWork::Yes,
        ..HitchStatus::default()
    };
    let message = StatusMessage::new(&status, LimitStatus::OperatorLimited, ExitCode::LockedOut);
    assert_eq!(
        message.to_bytes(),
        [0x9B, 0x4F, 0xFF, 0xFF, 0xFF, 0xC0 | 21, 0xFF, 0xFF]
    );
    let unknown = StatusMessage::new(
        &HitchStatus::default(),
        LimitStatus::NonRecoverable,
        ExitCode::FunctionFault,
    );
    assert_eq!(
        unknown.to_bytes()[..2],
        [0xFE, 0xF7],
        "error; not available"
    );
}

#[test]
fn a_draft_has_ten_newton_a_bit_and_a_lost_one_is_an_error() {
    for (draft, raw) in [
        (Draft::NotFitted, 0xFFFF),
        (Draft::Lost, 0xFE00),
        (Draft::Measured(Newton(2_550)), 32_255),
        (Draft::Measured(Newton(-2_554)), 31_745),
        (Draft::Measured(Newton(-2_556)), 31_744),
        (Draft::Measured(Newton(i32::MIN)), 0),
        (Draft::Measured(Newton(i32::MAX)), 0xFAFF),
    ] {
        let status = HitchStatus {
            draft,
            ..HitchStatus::default()
        };
        let message = StatusMessage::new(&status, LimitStatus::NotLimited, ExitCode::Clear);
        assert_eq!(message.draft, raw, "{draft:?}");
    }
}

#[test]
fn in_work_has_two_bits_and_the_time_until_then_a_millisecond_a_bit() {
    let mut bus = Bus::claimed(Variant::J1939);
    bus.run(1_000);
    assert!(
        bus.take(Pgn::HITCH_WORK).is_empty(),
        "no threshold, no time"
    );
    for (in_work, time_ms, bits, raw) in [
        (InWork::No, None, 0b00, [0xFF, 0xFF]),
        (InWork::No, Some(1_234), 0b00, [0xD2, 0x04]),
        (InWork::No, Some(i32::MAX), 0b00, [0xFF, 0xFA]),
        (InWork::Yes, Some(0), 0b01, [0, 0]),
        (InWork::Error, None, 0b10, [0xFF, 0xFF]),
    ] {
        bus.status.in_work = in_work;
        bus.status.time_until_work = time_ms.map(Millisecond);
        bus.run(200);
        bus.sent.clear();
        bus.run(1_000);
        let of = |pgn| bus.sent.iter().filter(move |sent| sent.id.pgn == pgn);
        assert_eq!(of(Pgn::HITCH_WORK).count(), 10);
        let [low, high] = raw;
        let expected = [low, high, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF];
        assert!(of(Pgn::HITCH_WORK).all(|sent| sent.data() == expected));
        let status = of(Pgn::REAR_HITCH_STATUS).next().unwrap();
        let status = StatusMessage::from_bytes(status.frame.eight().unwrap());
        assert_eq!(status.in_work, in_work);
        assert_eq!(status.to_bytes()[1] >> 6, bits);
    }
}

#[test]
fn a_draft_that_changes_all_the_time_is_sent_ten_times_a_second() {
    let mut bus = Bus::claimed(Variant::J1939);
    for step in 0..1_000 {
        bus.status.draft = Draft::Measured(Newton(15_000 + 37 * (step % 50)));
        bus.step();
    }
    let sent = bus.take(Pgn::REAR_HITCH_STATUS);
    assert_eq!(sent.len(), 10);
}

#[test]
fn the_tables_of_codes_are_those_of_the_standard() {
    let limits = [
        LimitStatus::NotLimited,
        LimitStatus::OperatorLimited,
        LimitStatus::LimitedHigh,
        LimitStatus::LimitedLow,
        LimitStatus::Reserved,
        LimitStatus::Reserved,
        LimitStatus::NonRecoverable,
        LimitStatus::NotAvailable,
    ];
    for (bits, limit) in (0..).zip(limits) {
        let bytes = [0, 0xC7 | (bits << 3), 0, 0, 0, 0xFF, 0xFF, 0xFF];
        assert_eq!(StatusMessage::from_bytes(&bytes).limit, limit);
    }
    let reasons = [
        (0, ExitCode::Clear),
        (1, ExitCode::NoOperator),
        (2, ExitCode::Released),
        (3, ExitCode::OperatorOverride),
        (4, ExitCode::ControlNotValid),
        (5, ExitCode::Timeout),
        (6, ExitCode::OutOfRange),
        (7, ExitCode::NotCalibrated),
        (8, ExitCode::ControlFault),
        (9, ExitCode::FunctionFault),
        (20, ExitCode::OilLevelLow),
        (21, ExitCode::LockedOut),
        (62, ExitCode::Error),
        (63, ExitCode::NotAvailable),
    ];
    for (code, reason) in reasons {
        assert_eq!(reason as u8, code);
        assert_eq!(ExitCode::from_bits(code), reason);
    }
    assert_eq!(ExitCode::from_bits(30), ExitCode::NotAvailable, "reserved");
}

#[test]
fn every_position_is_exact() {
    for raw in 0..=250 {
        assert_eq!(raw_position(Some(position(raw))), raw);
    }
    assert_eq!(raw_position(Some(PerMille(621))), 155, "rounded down");
    assert_eq!(raw_position(Some(PerMille(622))), 156, "rounded up");
    assert_eq!(raw_position(Some(PerMille(-20))), 0, "below the end");
    assert_eq!(raw_position(Some(PerMille(1_020))), 250, "above the end");
}

#[test]
fn commands_to_the_rear_hitch_are_in_the_second_byte() {
    let with = |rear: u8| HitchCommand::from_bytes(&[7, rear, 7, 7, 7, 7, 7, 7]);
    assert_eq!(with(0), HitchCommand::Position(0));
    assert_eq!(with(250), HitchCommand::Position(250));
    for reserved in 251..=254 {
        assert_eq!(with(reserved), HitchCommand::OutOfRange);
    }
    assert_eq!(with(255), HitchCommand::None);
    assert_eq!(
        HitchCommand::Position(155).to_bytes(),
        [0xFF, 155, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF],
        "nothing else is asked for"
    );
}

#[test]
fn a_frame_carries_at_most_eight_bytes() {
    let id = ExtendedId::ZERO.into();
    assert!(Frame::data_frame(id, &[0; 8]).is_some());
    assert!(Frame::data_frame(id, &[0; 9]).is_none());
    assert!(Frame::remote_frame(id, 9).is_none());
}
