//! Engine speed from the bus.

use crate::bus::{Bus, OTHER};
use hitch_protocols::j1939::{Pgn, Variant};
use hitch_quantities::units::RevolutionPerMinute;

fn message(raw: u16) -> [u8; 8] {
    let [low, high] = raw.to_le_bytes();
    [0xFF, 0xFF, 0xFF, low, high, 0xFF, 0xFF, 0xFF]
}

fn heard(bus: &mut Bus, source: u8, raw: u16) -> Option<i32> {
    bus.receive(Pgn::ENGINE, 0xFF, source, &message(raw));
    known(bus)
}

fn known(bus: &Bus) -> Option<i32> {
    let speed = bus.node.engine_speed(bus.now_ms);
    speed.map(|RevolutionPerMinute(speed)| speed)
}

#[test]
fn the_speed_has_an_eighth_of_a_revolution_a_bit() {
    let mut bus = Bus::new(Variant::J1939);
    assert_eq!(known(&bus), None);
    for (raw, speed) in [
        (0, 0),
        (7, 0),
        (8, 1),
        (3_208, 401),
        (12_000, 1_500),
        (0xFAFF, 8_031),
    ] {
        assert_eq!(heard(&mut bus, 0, raw), Some(speed), "{raw}");
    }
}

#[test]
fn reserved_values_errors_and_not_available_are_no_speed() {
    for raw in [0xFB00, 0xFDFF, 0xFE00, 0xFEFF, 0xFF00, 0xFFFF] {
        let mut bus = Bus::new(Variant::J1939);
        assert_eq!(heard(&mut bus, 0, 8_000), Some(1_000));
        assert_eq!(heard(&mut bus, 0, raw), None, "{raw:X}");
    }
}

#[test]
fn silence_ends_it_after_300_ms_and_for_good() {
    let mut bus = Bus::new(Variant::J1939);
    heard(&mut bus, 0, 8_000);
    bus.run(300);
    assert_eq!(known(&bus), Some(1_000));
    bus.run(1);
    assert_eq!(known(&bus), None);
    // Not even when the milliseconds have wrapped.
    bus.run(1);
    bus.now_ms = bus.now_ms.wrapping_sub(302);
    assert_eq!(known(&bus), None);
}

// REQ-SAFE-08
#[test]
fn only_the_addresses_of_the_calibration_tell_it() {
    let told_by = |sources: Option<[u8; 2]>| {
        (0..=u8::MAX).filter(move |&source| {
            let mut bus = Bus::new(Variant::J1939);
            if let Some(sources) = sources {
                bus.node.accept_engine_speed_from(sources);
            }
            heard(&mut bus, source, 8_000).is_some()
        })
    };
    assert!(told_by(None).eq([0, 1]), "the engines");
    assert!(told_by(Some([OTHER, 0xFD])).eq([OTHER, 0xFD]));
    assert!(told_by(Some([0, 0])).eq([0]));
}

#[test]
fn of_two_engines_the_first_one_counts() {
    for (first, second) in [(0, 1), (1, 0)] {
        let mut bus = Bus::new(Variant::J1939);
        assert_eq!(heard(&mut bus, first, 8_000), Some(1_000));
        assert_eq!(heard(&mut bus, second, 0), Some(1_000));
        bus.run(301);
        assert_eq!(
            heard(&mut bus, second, 0),
            Some(0),
            "the first one is silent"
        );
    }
}

#[test]
fn a_message_of_another_length_is_none() {
    let mut bus = Bus::new(Variant::J1939);
    for length in 0..8 {
        bus.receive(Pgn::ENGINE, 0xFF, 0, &message(8_000)[..length]);
        assert_eq!(known(&bus), None, "{length}");
    }
}
