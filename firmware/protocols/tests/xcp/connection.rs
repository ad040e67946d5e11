//! Connection, status, identity, and accepted senders.

use hitch_protocols::can::Frame;
use hitch_protocols::j1939::{Id, Pgn};
use hitch_protocols::xcp::map::{CALIBRATION_BASE, IDENTITY, IDENTITY_BASE};
use hitch_protocols::xcp::{Access, Event, TOOL_ADDRESS};
use hitch_quantities::Calibration;
use hitch_quantities::calibration::calibration_words::CALIBRATION_WORDS;
use hitch_quantities::crc32::Crc32;

use crate::client::{ACCESS_DENIED, ACCESS_LOCKED, Desk, ECU, OUT_OF_RANGE, frame, word_address};

#[test]
fn a_tool_connects_and_learns_what_there_is() {
    let mut desk = Desk::new();
    // Calibrating and measuring; little-endian with more information; 8 bytes both ways; versions 1.
    assert_eq!(desk.obeyed(&[0xFF, 0]), [0x05, 0x80, 8, 8, 0, 1, 1]);
    assert!(desk.slave.is_connected());
    assert_eq!(
        desk.obeyed(&[0xFD]),
        [0, 0, 0, 0, 0],
        "nothing going on, nothing protected"
    );
    assert_eq!(desk.ask(&[0xFC]), Err(0x00), "SYNCH is answered so");
    assert_eq!(desk.obeyed(&[0xFB])[1], 0, "no block mode");
    desk.obeyed(&[0xFE]);
    assert!(!desk.slave.is_connected());
}

#[test]
fn before_connect_and_after_disconnect_nothing_is_answered() {
    let mut desk = Desk::new();
    for command in 0..0xFF {
        desk.send(&[command, 0, 0, 0, 0, 0, 0, 0]);
        assert!(desk.packets().is_empty(), "{command:02X}");
    }
}

#[test]
fn only_the_tool_is_heard_and_only_at_our_address() {
    let mut desk = Desk::new();
    desk.receive(&frame(&[0xFF, 0], ECU, 0x26));
    desk.receive(&frame(&[0xFF, 0], 0x81, TOOL_ADDRESS));
    desk.receive(&frame(&[0xFF, 0], 0xFF, TOOL_ADDRESS));
    let id = Id {
        priority: 6,
        pgn: Pgn(0xEA00),
        destination: ECU,
        source: TOOL_ADDRESS,
    };
    desk.receive(&Frame::data_frame(id.pack().into(), &[0xFF, 0]).unwrap());
    assert!(!desk.slave.is_connected());
    // An ECU without address, or with a new one, does not answer at the old one.
    desk.slave.set_address(None);
    desk.send(&[0xFF, 0]);
    assert!(!desk.slave.is_connected());
    desk.slave.set_address(Some(0x81));
    desk.send(&[0xFF, 0]);
    assert!(!desk.slave.is_connected());
    desk.receive(&frame(&[0xFF, 0], 0x81, TOOL_ADDRESS));
    assert!(desk.slave.is_connected());
    let answer = desk.slave.poll().unwrap();
    assert_eq!(answer.extended_data_id().unwrap().as_raw(), 0x18EF_F981);
}

#[test]
fn a_connection_ends_with_the_address() {
    let mut desk = Desk::connected();
    desk.slave.set_address(Some(ECU));
    assert!(desk.slave.is_connected(), "the same again is no change");
    desk.slave.set_address(Some(0x81));
    assert!(!desk.slave.is_connected());
}

#[test]
fn the_description_file_is_named_and_agrees() {
    let mut desk = Desk::connected();
    let length = desk.obeyed(&[0xFA, 1])[3];
    assert_eq!(desk.obeyed(&[0xF5, length]), b"hitch");
    let length = desk.obeyed(&[0xFA, 0])[3];
    let mut text = Vec::new();
    while text.len() < usize::from(length) {
        let piece = (usize::from(length) - text.len()).min(7);
        text.extend(desk.obeyed(&[0xF5, u8::try_from(piece).unwrap()]));
    }
    assert_eq!(text, IDENTITY);
    assert_eq!(desk.obeyed(&[0xFA, 4])[3], 0, "no file to upload");
}

#[test]
fn the_checksum_of_the_calibration_comes_in_bounded_pieces() {
    let mut desk = Desk::connected();
    let block = Calibration::nominal().to_bytes();
    let length = u32::try_from(block.len()).unwrap();
    desk.set_address(CALIBRATION_BASE);
    let [a, b, c, d] = length.to_le_bytes();
    desk.send(&[0xF3, 0, 0, 0, a, b, c, d]);
    let mut steps = 0;
    let answer = loop {
        desk.event(Event::Every1Ms);
        steps += 1;
        if let Some(answer) = desk.packets().pop() {
            break answer;
        }
    };
    assert_eq!(steps, block.len().div_ceil(64));
    let checksum = Crc32::of(&block).to_le_bytes();
    assert_eq!(answer, [&[0xFF, 9, 0, 0], &checksum[..]].concat());
    desk.send(&[0xF3, 0, 0, 0, 0, 0, 1, 0]);
    assert_eq!(
        desk.packets(),
        [[0xFE, OUT_OF_RANGE, 0, 0, 0, 0x40, 0, 0]],
        "too long: and how long it may be"
    );
}

#[test]
fn there_is_nothing_between_the_windows() {
    let mut desk = Desk::connected();
    let behind = word_address(CALIBRATION_WORDS);
    for address in [
        0,
        0x0800_0000,
        0x2000_1000,
        IDENTITY_BASE + 64,
        behind,
        u32::MAX,
        CALIBRATION_BASE - 1,
    ] {
        assert_eq!(desk.read(address), Err(ACCESS_DENIED), "{address:08X}");
    }
    assert_eq!(
        desk.read(behind - 2),
        Err(ACCESS_DENIED),
        "half of it isn't there"
    );
    // Another address space.
    assert_eq!(
        desk.ask(&[0xF4, 4, 0, 1, 0, 0, 0, 0x10]),
        Err(ACCESS_DENIED)
    );
}

#[test]
fn short_commands_and_unknown_ones_are_refused() {
    let mut desk = Desk::connected();
    let mut unknown = 0;
    for command in 0..=0xFC_u8 {
        match desk.ask(&[command]) {
            // These have no arguments.
            Ok(_) => assert!(
                matches!(command, 0xFB | 0xE9 | 0xDC | 0xDA | 0xD9 | 0xD6),
                "{command:02X}"
            ),
            Err(0x20) => unknown += 1,
            Err(error) => assert!(
                matches!(error, 0x00 | 0x21 | 0x29),
                "{command:02X}: {error:02X}"
            ),
        }
    }
    assert_eq!(
        unknown,
        253 - 33,
        "beside CONNECT, DISCONNECT and GET_STATUS there are 33"
    );
}

#[test]
fn tuning_is_enabled_at_the_machine_and_nowhere_else() {
    let mut desk = Desk::connected();
    desk.access = Access::Locked;
    assert_eq!(desk.obeyed(&[0xFD])[1], 0x01, "calibration is protected");
    assert_eq!(
        desk.ask(&[0xF8, 0, 1]),
        Err(ACCESS_LOCKED),
        "there is no seed"
    );
    assert_eq!(desk.ask(&[0xF7, 1, 0]), Err(0x29), "and no key");
    desk.access = Access::Moving;
    assert_eq!(desk.obeyed(&[0xFD])[1], 0x00);
    assert_eq!(
        desk.ask(&[0xF8, 0, 1]),
        Err(ACCESS_LOCKED),
        "without a secret there is no seed"
    );
    assert_eq!(
        desk.obeyed(&[0xF8, 0, 4]),
        [0],
        "measuring is unlocked: a seed of no bytes"
    );
}
