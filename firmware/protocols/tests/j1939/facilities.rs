//! The facilities that the node sends, and those that implements require (ISO 11783-7, B.24.3 and B.24.4).

use hitch_protocols::j1939::{Draft, InWork, Pgn, Variant};
use hitch_quantities::calibration::design_parameters::RemoteParameters;
use hitch_quantities::units::Count;

use crate::bus::{Bus, OTHER};

/// No class; position; no draft; commands and their limit status; reserved bits are 0.
const WITH_COMMANDS: [u8; 8] = [0xC0, 0x80, 0, 0x88, 0, 0, 0, 0];

/// The facilities that were sent since the last call.
fn told(bus: &mut Bus) -> Vec<[u8; 8]> {
    let sent = bus.take(Pgn::TRACTOR_FACILITIES);
    sent.iter()
        .map(|sent| {
            assert_eq!((sent.id.priority, sent.id.destination), (3, 0xFF));
            sent.data().try_into().unwrap()
        })
        .collect()
}

/// The answer to a request of everybody.
fn asked(bus: &mut Bus) -> [u8; 8] {
    bus.ask(Pgn::TRACTOR_FACILITIES, 0xFF);
    bus.run(10);
    let told = told(bus);
    assert_eq!(told.len(), 1);
    told[0]
}

#[test]
fn they_are_told_once_after_the_start_and_on_request() {
    let mut bus = Bus::new(Variant::Iso11783);
    bus.run(250);
    assert!(told(&mut bus).is_empty(), "without an address");
    bus.run(5_000);
    assert_eq!(told(&mut bus), [WITH_COMMANDS]);
    assert_eq!(asked(&mut bus), WITH_COMMANDS);
}

#[test]
fn they_are_what_is_fitted_whatever_is_required_and_whatever_is_lost() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.node.bound_remote_control(RemoteParameters {
        consent: Count(0),
        ..RemoteParameters::NOMINAL
    });
    assert_eq!(asked(&mut bus), [0xC0, 0x80, 0, 0, 0, 0, 0, 0]);
    bus.status.draft = Draft::Lost;
    assert_eq!(asked(&mut bus), [0xC0, 0x80, 0b100, 0, 0, 0, 0, 0]);
    bus.status.in_work = InWork::Error;
    let fitted = [0xC0, 0xC0, 0b100, 0, 0, 0, 0, 0];
    assert_eq!(asked(&mut bus), fitted);
    for required in [[0; 8], [0xFF; 8], WITH_COMMANDS] {
        bus.receive(Pgn::REQUIRED_FACILITIES, 0xFF, OTHER, &required);
        bus.run(10);
        assert_eq!(told(&mut bus), [fitted]);
    }
}

#[test]
fn several_implements_get_one_answer() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for implement in 0..20 {
        let required = [0, 0x80, 0, 0x88, 0, 0, 0, 0];
        bus.receive(Pgn::REQUIRED_FACILITIES, 0xFF, 0x30 + implement, &required);
    }
    bus.run(1_000);
    assert_eq!(told(&mut bus), [WITH_COMMANDS]);
}

#[test]
fn the_status_goes_on_though_nobody_requires_it() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.receive(Pgn::REQUIRED_FACILITIES, 0xFF, OTHER, &[0; 8]);
    bus.run(1_000);
    let statuses = bus.take(Pgn::REAR_HITCH_STATUS).len();
    assert!((10..=11).contains(&statuses), "{statuses} in a second");
}
