//! Trouble codes and requests.

use hitch_protocols::j1939::{Pgn, Trouble, TroubleFinder, Troubles, Variant};
use hitch_quantities::calibration::design_parameters::{LockParameters, OperatorParameters};
use hitch_quantities::signals::field;
use hitch_quantities::units::{Count, MilliAmp, MilliVolt, RevolutionPerMinute};
use hitch_quantities::{Fault, Inputs, Outputs, Trip};

use crate::bus::{Bus, OTHER, OURS};

/// A set of troubles.
pub fn troubles(list: &[Trouble]) -> Troubles {
    let mut set = Troubles::NONE;
    list.iter().for_each(|&trouble| set.insert(trouble));
    set
}

#[test]
fn iso_11783_is_silent_until_something_is_wrong_and_then_again() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.run(3_000);
    assert!(bus.take(Pgn::DM1).is_empty());
    bus.status.troubles = troubles(&[Trouble::SupplyLow]);
    let begun_ms = bus.now_ms;
    bus.run(3_000);
    let messages = bus.take(Pgn::DM1);
    assert_eq!(messages[0].at_ms, begun_ms, "at once");
    assert_eq!(messages.len(), 3, "and once a second");
    // Lamps not used; SPN 168, FMI 4, first occurrence.
    assert_eq!(messages[0].data(), [0xFF, 0xFF, 168, 0, 4, 1, 0xFF, 0xFF]);
    assert_eq!(
        messages[0].frame.extended_data_id().unwrap().as_raw(),
        0x18FE_CA80
    );
    bus.status.troubles = Troubles::NONE;
    bus.run(3_000);
    assert!(bus.take(Pgn::DM1).is_empty());
}

#[test]
fn j1939_reports_lamps_and_goes_on() {
    let mut bus = Bus::claimed(Variant::J1939);
    bus.run(2_000);
    let messages = bus.take(Pgn::DM1);
    assert_eq!(messages.len(), 2);
    assert_eq!(
        messages[0].data(),
        [0, 0xFF, 0, 0, 0, 0, 0xFF, 0xFF],
        "nothing active"
    );
    bus.status.troubles = troubles(&[Trouble::LeverHigh]);
    bus.run(1_000);
    // Amber lamp; SPN 520192 = 0x7F000, FMI 3.
    assert_eq!(
        bus.take(Pgn::DM1)[0].data(),
        [0x04, 0xFF, 0x00, 0xF0, 0xE3, 1, 0xFF, 0xFF]
    );
    bus.status.troubles = troubles(&[Trouble::LiftCoilShort]);
    bus.run(1_000);
    // Red stop lamp; SPN 520193, FMI 6.
    assert_eq!(
        bus.take(Pgn::DM1)[0].data(),
        [0x10, 0xFF, 0x01, 0xF0, 0xE6, 1, 0xFF, 0xFF]
    );
}

#[test]
fn what_comes_and_goes_is_reported_once_a_second_at_most_and_counted() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for round in 0..5_000 {
        let active = round % 10 < 5;
        bus.status.troubles = troubles(if active { &[Trouble::AngleJumps] } else { &[] });
        bus.step();
    }
    let messages = bus.take(Pgn::DM1);
    assert!(messages.len() <= 5, "{}", messages.len());
    assert_eq!(
        messages[messages.len() - 1].data()[5],
        126,
        "the count ends there"
    );
}

#[test]
fn every_trouble_has_a_code_of_its_own() {
    for (index, trouble) in Trouble::ALL.iter().enumerate() {
        let code = trouble.code();
        assert!(code.spn < 1 << 19 && code.fmi < 32);
        assert!(
            Trouble::ALL[..index]
                .iter()
                .all(|other| other.code() != code),
            "{trouble:?}"
        );
    }
}

#[test]
fn what_was_wrong_is_remembered_until_it_is_cleared() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.status.troubles = troubles(&[Trouble::SupplyHigh]);
    bus.run(10);
    bus.status.troubles = Troubles::NONE;
    bus.run(10);
    bus.ask(Pgn::DM2, OURS);
    bus.run(10);
    assert_eq!(
        bus.take(Pgn::DM2)[0].data(),
        [0xFF, 0xFF, 168, 0, 3, 1, 0xFF, 0xFF]
    );
    bus.ask(Pgn::DM3, OURS);
    bus.run(10);
    // Positive, for the one who asked, DM3.
    assert_eq!(
        bus.take(Pgn::ACKNOWLEDGEMENT)[0].data(),
        [0, 0xFF, 0xFF, 0xFF, OTHER, 0xCC, 0xFE, 0]
    );
    bus.ask(Pgn::DM2, 0xFF);
    bus.run(10);
    assert_eq!(
        bus.take(Pgn::DM2)[0].data(),
        [0xFF, 0xFF, 0, 0, 0, 0, 0xFF, 0xFF]
    );
}

#[test]
fn clearing_leaves_what_is_active() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.status.troubles = troubles(&[Trouble::SupplyHigh]);
    bus.run(10);
    bus.ask(Pgn::DM3, 0xFF);
    bus.run(10);
    assert!(
        bus.take(Pgn::ACKNOWLEDGEMENT).is_empty(),
        "everybody was asked"
    );
    bus.ask(Pgn::DM1, OURS);
    bus.run(10);
    assert_eq!(bus.take(Pgn::DM1)[0].data()[2..6], [168, 0, 3, 1]);
}

#[test]
fn unknown_groups_are_refused_to_who_asks_us_alone() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.ask(Pgn(0xFEE5), 0xFF);
    bus.ask(Pgn(0xFEE5), 0x99);
    bus.run(20);
    assert!(bus.take(Pgn::ACKNOWLEDGEMENT).is_empty());
    bus.ask(Pgn(0xFEE5), OURS);
    bus.run(20);
    let refusals = bus.take(Pgn::ACKNOWLEDGEMENT);
    assert_eq!(
        refusals[0].data(),
        [1, 0xFF, 0xFF, 0xFF, OTHER, 0xE5, 0xFE, 0]
    );
    assert_eq!(
        refusals[0].frame.extended_data_id().unwrap().as_raw(),
        0x18E8_FF80
    );
    bus.ask(Pgn::REAR_HITCH_STATUS, OURS);
    bus.run(20);
    assert!(
        bus.sent
            .iter()
            .all(|sent| sent.id.pgn != Pgn::ACKNOWLEDGEMENT)
    );
}

fn tripped(trip: Trip) -> Outputs {
    Outputs {
        trip: Some(trip),
        fault: Some(Fault::Envelope),
        ..Outputs::default()
    }
}

fn currents(lift: i32, lower: i32) -> Inputs {
    Inputs {
        lift_current: Some(MilliAmp(lift)),
        lower_current: Some(MilliAmp(lower)),
        ..Inputs::default()
    }
}

const LOCK: LockParameters = LockParameters::NOMINAL;
const OPERATOR: OperatorParameters = OperatorParameters::NOMINAL;

// REQ-SAFE-08
#[test]
fn a_lost_engine_speed_has_its_code_until_it_is_received_again() {
    let required = LockParameters {
        engine_required: Count(1),
        ..LOCK
    };
    let speed = Some(RevolutionPerMinute(800));
    let after = |finder: &mut TroubleFinder, engine_speed, lock, ms| {
        let inputs = Inputs {
            engine_speed,
            ..Inputs::default()
        };
        let mut found = Troubles::NONE;
        for _ in 0..ms {
            found = finder.update(&inputs, &Outputs::default(), lock, &OPERATOR);
        }
        found
    };
    let lost = Troubles::from(Trouble::EngineSpeedLost);
    let mut finder = TroubleFinder::default();
    assert_eq!(after(&mut finder, None, &LOCK, 5_000), Troubles::NONE);
    for _ in 0..2 {
        assert_eq!(after(&mut finder, speed, &LOCK, 1), Troubles::NONE);
        assert_eq!(after(&mut finder, None, &LOCK, 999), Troubles::NONE);
        assert_eq!(after(&mut finder, None, &LOCK, 1), lost);
        assert_eq!(after(&mut finder, None, &LOCK, 100_000), lost);
    }
    let mut finder = TroubleFinder::default();
    assert_eq!(after(&mut finder, None, &required, 999), Troubles::NONE);
    assert_eq!(after(&mut finder, None, &required, 1), lost);
    assert_eq!(after(&mut finder, speed, &required, 1), Troubles::NONE);
    let open = tripped(Trip::CoilOpen);
    let mut finder = TroubleFinder::default();
    after(&mut finder, None, &required, 1_000);
    let both = finder.update(&Inputs::default(), &open, &required, &OPERATOR);
    assert_eq!(both, lost.union(Trouble::Coils.into()));
}

#[test]
fn lost_sensors_of_draft_and_slip_have_their_codes() {
    let after = |finder: &mut TroubleFinder, trouble, ms| {
        let outputs = Outputs {
            trouble,
            ..Outputs::default()
        };
        let mut found = Troubles::NONE;
        for _ in 0..ms {
            found = finder.update(&Inputs::default(), &outputs, &LOCK, &OPERATOR);
        }
        found
    };
    // A speed may be missing for a second: its sender starts, or changes.
    for (lost, trouble, spn, fmi, ms) in [
        (
            field::Trouble::PinRange,
            Trouble::DraftPinMissing,
            1879,
            31,
            1,
        ),
        (field::Trouble::PinsDisagree, Trouble::DraftPins, 1879, 2, 1),
        (field::Trouble::PinNoisy, Trouble::DraftPins, 1879, 2, 1),
        (
            field::Trouble::PinFrozen,
            Trouble::DraftPinFrozen,
            1879,
            9,
            1,
        ),
        (
            field::Trouble::GroundSpeed,
            Trouble::GroundSpeedLost,
            1859,
            9,
            1_000,
        ),
        (
            field::Trouble::WheelSpeed,
            Trouble::WheelSpeedLost,
            1862,
            9,
            1_000,
        ),
        (
            field::Trouble::SpeedFrozen,
            Trouble::SpeedFrozen,
            520_212,
            2,
            1,
        ),
        (
            field::Trouble::DepthRange,
            Trouble::DepthSensorMissing,
            520_214,
            31,
            1,
        ),
        (
            field::Trouble::DepthFrozen,
            Trouble::DepthSensorFrozen,
            520_214,
            9,
            1,
        ),
        (
            field::Trouble::DepthNoisy,
            Trouble::DepthSensorNoisy,
            520_214,
            2,
            1,
        ),
    ] {
        let mut finder = TroubleFinder::default();
        assert_eq!(after(&mut finder, Some(lost), ms - 1), Troubles::NONE);
        assert_eq!(after(&mut finder, Some(lost), 1), trouble.into());
        assert_eq!(after(&mut finder, None, 1), Troubles::NONE);
        assert_eq!((trouble.code().spn, trouble.code().fmi), (spn, fmi));
    }
}

#[test]
fn what_trips_the_envelope_gets_the_code_that_leads_to_it() {
    let found = |trip, inputs: &Inputs| {
        TroubleFinder::default().update(inputs, &tripped(trip), &LOCK, &OPERATOR)
    };
    let supply = |millivolt| Inputs {
        supply: Some(MilliVolt(millivolt)),
        ..Inputs::default()
    };
    assert_eq!(
        found(Trip::Supply, &supply(7_000)),
        Trouble::SupplyLow.into()
    );
    assert_eq!(
        found(Trip::Supply, &supply(17_000)),
        Trouble::SupplyHigh.into()
    );
    let stuck = |inputs| found(Trip::CoilStuck, &inputs);
    assert_eq!(stuck(currents(900, 3)), Trouble::LiftCoilShort.into());
    assert_eq!(stuck(currents(3, 900)), Trouble::LoweringCoilShort.into());
    for row in Trip::ALL {
        assert_eq!(found(row, &Inputs::default()).count(), 1, "{row:?}");
    }
    let sinking = Outputs {
        fault: Some(Fault::Sinking),
        ..Outputs::default()
    };
    let mut finder = TroubleFinder::default();
    let inputs = Inputs::default();
    assert_eq!(
        finder.update(&inputs, &sinking, &LOCK, &OPERATOR),
        Trouble::Sinking.into()
    );
    assert_eq!(
        finder.update(&inputs, &Outputs::default(), &LOCK, &OPERATOR),
        Troubles::NONE
    );
}

#[test]
fn which_coil_it_was_is_still_known_when_both_are_off() {
    let mut finder = TroubleFinder::default();
    let lowering = Outputs {
        lower_current: MilliAmp(1_500),
        ..Outputs::default()
    };
    finder.update(&currents(0, 0), &lowering, &LOCK, &OPERATOR);
    let open = tripped(Trip::CoilOpen);
    assert_eq!(
        finder.update(&currents(0, 0), &open, &LOCK, &OPERATOR),
        Trouble::LoweringCoilOpen.into()
    );
    let short = tripped(Trip::CoilShort);
    assert_eq!(
        finder.update(&currents(3_000, 0), &short, &LOCK, &OPERATOR),
        Trouble::LiftCoilShort.into()
    );
    assert_eq!(
        finder.update(&currents(0, 1), &short, &LOCK, &OPERATOR),
        Trouble::LiftCoilShort.into()
    );
}

#[test]
fn requests_that_are_too_short_are_none() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for length in 0..3 {
        bus.receive(Pgn::REQUEST, OURS, OTHER, &[0xCA, 0xFE, 0][..length]);
    }
    let id = bus.sent.len();
    bus.run(20);
    assert!(
        bus.sent[id..]
            .iter()
            .all(|sent| sent.id.pgn == Pgn::REAR_HITCH_STATUS)
    );
}

#[test]
fn what_is_back_is_no_longer_previous() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for set in [
        troubles(&[Trouble::SupplyHigh]),
        Troubles::NONE,
        troubles(&[Trouble::SupplyHigh]),
    ] {
        bus.status.troubles = set;
        bus.run(10);
    }
    bus.sent.clear();
    bus.ask(Pgn::DM2, OURS);
    bus.run(10);
    assert_eq!(bus.take(Pgn::DM2)[0].data()[2..6], [0; 4]);
    bus.ask(Pgn::DM1, OURS);
    bus.run(10);
    assert_eq!(
        bus.take(Pgn::DM1)[0].data()[2..6],
        [168, 0, 3, 2],
        "for the second time"
    );
}

#[test]
fn a_request_that_comes_twice_is_answered_once() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for _ in 0..20 {
        bus.ask(Pgn::DM2, OURS);
    }
    bus.ask(Pgn::DM1, OURS);
    bus.run(100);
    let count = |pgn| bus.sent.iter().filter(|sent| sent.id.pgn == pgn).count();
    assert_eq!((count(Pgn::DM2), count(Pgn::DM1)), (1, 1));
}
