//! Trouble codes, requests, and the transport of what is too long for a frame.

use hitch_firmware::control::safety::Trip;
use hitch_firmware::control::units::{MilliAmp, MilliVolt};
use hitch_firmware::control::{Fault, Inputs, Outputs};
use hitch_firmware::j1939::{Pgn, Trouble, TroubleFinder, Troubles, Variant};

use crate::bus::{Bus, OTHER, OURS, Sent};

fn troubles(list: &[Trouble]) -> Troubles {
    let mut set = Troubles::NONE;
    list.iter().for_each(|&trouble| set.insert(trouble));
    set
}

/// Puts a broadcast together again, as a receiver does.
fn reassembled(sent: &[Sent], group: Pgn) -> Vec<u8> {
    let announcement = sent
        .iter()
        .find(|sent| sent.id.pgn == Pgn::TRANSPORT_CONNECTION)
        .expect("a broadcast is announced");
    let [control, low, high, packets, 0xFF, a, b, c] = *announcement.frame.eight().unwrap() else {
        panic!("{announcement:?}");
    };
    assert_eq!((control, Pgn::from_bytes([a, b, c])), (32, group));
    assert_eq!(announcement.id.destination, 0xFF);
    let data: Vec<&Sent> = sent
        .iter()
        .filter(|sent| sent.id.pgn == Pgn::TRANSPORT_DATA)
        .take(usize::from(packets))
        .collect();
    assert_eq!(data.len(), usize::from(packets));
    for (number, pair) in (1_u8..).zip(data.windows(2)) {
        assert_eq!(pair[0].data()[0], number);
        let gap_ms = pair[1].at_ms.wrapping_sub(pair[0].at_ms);
        assert!((50..=200).contains(&gap_ms), "{gap_ms} ms");
    }
    let mut bytes: Vec<u8> = data
        .iter()
        .flat_map(|sent| sent.data()[1..].to_vec())
        .collect();
    bytes.truncate(usize::from(u16::from_le_bytes([low, high])));
    bytes
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
fn several_codes_go_as_a_broadcast() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.status.troubles = troubles(Trouble::ALL);
    bus.run(1_500);
    let bytes = reassembled(&bus.sent, Pgn::DM1);
    assert_eq!(bytes.len(), 2 + 4 * Trouble::ALL.len());
    for (trouble, code) in Trouble::ALL.iter().zip(bytes[2..].chunks(4)) {
        let spn = u32::from(code[0]) | u32::from(code[1]) << 8 | u32::from(code[2] >> 5) << 16;
        assert_eq!(
            (spn, code[2] & 0x1F),
            (trouble.code().spn, trouble.code().fmi)
        );
    }
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

/// A bus on which DM2 is too long for a frame.
fn bus_with_history() -> Bus {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.status.troubles = troubles(Trouble::ALL);
    bus.step();
    bus.status.troubles = Troubles::NONE;
    bus.run(1_500);
    bus.sent.clear();
    bus
}

fn management(bus: &mut Bus, data: [u8; 5]) {
    let [a, b, c] = Pgn::DM2.to_bytes();
    let [control, first, second, third, fourth] = data;
    let bytes = [control, first, second, third, fourth, a, b, c];
    bus.hear(Pgn::TRANSPORT_CONNECTION, OURS, OTHER, &bytes);
}

fn packets(bus: &mut Bus) -> Vec<u8> {
    let data = bus.take(Pgn::TRANSPORT_DATA);
    data.iter().map(|sent| sent.data()[0]).collect()
}

#[test]
fn one_node_gets_a_long_message_at_its_own_pace() {
    let mut bus = bus_with_history();
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    let length = 2 + 4 * Trouble::ALL.len();
    let count = u8::try_from(length.div_ceil(7)).unwrap();
    let request = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert_eq!(
        request[0].data(),
        [
            16,
            u8::try_from(length).unwrap(),
            0,
            count,
            0xFF,
            0xCB,
            0xFE,
            0
        ]
    );
    assert_eq!(request[0].id.destination, OTHER);
    bus.run(1_000);
    assert_eq!(
        packets(&mut bus),
        [0; 0],
        "nothing before it is cleared to send"
    );
    management(&mut bus, [17, 3, 1, 0xFF, 0xFF]);
    bus.run(50);
    assert_eq!(packets(&mut bus), [1, 2, 3]);
    management(&mut bus, [17, 0, 4, 0xFF, 0xFF]);
    bus.run(1_000);
    assert_eq!(packets(&mut bus), [0; 0], "told to wait");
    management(&mut bus, [17, 2, 2, 0xFF, 0xFF]);
    bus.run(50);
    assert_eq!(packets(&mut bus), [2, 3], "asked for again");
    management(&mut bus, [17, 0xFF, 4, 0xFF, 0xFF]);
    management(&mut bus, [17, 0xFF, 4, 0xFF, 0xFF]);
    bus.run(100);
    assert_eq!(packets(&mut bus), (4..=count).collect::<Vec<u8>>());
    management(
        &mut bus,
        [19, u8::try_from(length).unwrap(), 0, count, 0xFF],
    );
    bus.run(3_000);
    assert!(bus.take(Pgn::TRANSPORT_CONNECTION).is_empty(), "over");
}

#[test]
fn a_partner_that_falls_silent_or_asks_for_nonsense_ends_it() {
    let mut bus = bus_with_history();
    bus.ask(Pgn::DM2, OURS);
    bus.run(1_300);
    let ended = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert_eq!(
        ended[1].data(),
        [255, 3, 0xFF, 0xFF, 0xFF, 0xCB, 0xFE, 0],
        "time-out"
    );
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    management(&mut bus, [17, 1, 200, 0xFF, 0xFF]);
    bus.run(5);
    let ended = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert_eq!(ended[1].data()[..2], [255, 7], "no such packet");
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    management(&mut bus, [255, 1, 0xFF, 0xFF, 0xFF]);
    bus.run(2_000);
    assert_eq!(bus.take(Pgn::TRANSPORT_CONNECTION).len(), 1, "they gave up");
}

#[test]
fn a_second_long_message_has_to_wait_and_is_told_so() {
    let mut bus = bus_with_history();
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    bus.hear(Pgn::REQUEST, OURS, 0x30, &Pgn::DM2.to_bytes());
    bus.run(5);
    let refusal = bus.take(Pgn::ACKNOWLEDGEMENT);
    assert_eq!(
        refusal[0].data()[..5],
        [3, 0xFF, 0xFF, 0xFF, 0x30],
        "cannot respond now"
    );
}

#[test]
fn long_messages_to_us_are_refused() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    let request = [16, 20, 0, 3, 0xFF, 0x00, 0xEF, 0];
    bus.hear(Pgn::TRANSPORT_CONNECTION, OURS, OTHER, &request);
    bus.run(5);
    let refusal = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert_eq!(refusal[0].data(), [255, 2, 0xFF, 0xFF, 0xFF, 0x00, 0xEF, 0]);
    assert_eq!(refusal[0].id.destination, OTHER);
    // A broadcast is for whom it concerns.
    bus.hear(
        Pgn::TRANSPORT_CONNECTION,
        0xFF,
        OTHER,
        &[32, 20, 0, 3, 0xFF, 0, 0xEF, 0],
    );
    bus.run(5);
    assert!(bus.take(Pgn::TRANSPORT_CONNECTION).is_empty());
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

#[test]
fn what_trips_the_envelope_gets_the_code_that_leads_to_it() {
    let found = |trip, inputs: &Inputs| TroubleFinder::default().update(inputs, &tripped(trip));
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
    assert_eq!(finder.update(&inputs, &sinking), Trouble::Sinking.into());
    assert_eq!(finder.update(&inputs, &Outputs::default()), Troubles::NONE);
}

#[test]
fn which_coil_it_was_is_still_known_when_both_are_off() {
    let mut finder = TroubleFinder::default();
    let lowering = Outputs {
        lower_current: MilliAmp(1_500),
        ..Outputs::default()
    };
    finder.update(&currents(0, 0), &lowering);
    let open = tripped(Trip::CoilOpen);
    assert_eq!(
        finder.update(&currents(0, 0), &open),
        Trouble::LoweringCoilOpen.into()
    );
    let short = tripped(Trip::CoilShort);
    assert_eq!(
        finder.update(&currents(3_000, 0), &short),
        Trouble::LiftCoilShort.into()
    );
    assert_eq!(
        finder.update(&currents(0, 1), &short),
        Trouble::LiftCoilShort.into()
    );
}

#[test]
fn requests_that_are_too_short_are_none() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    for length in 0..3 {
        bus.hear(Pgn::REQUEST, OURS, OTHER, &[0xCA, 0xFE, 0][..length]);
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

#[test]
fn others_have_no_say_in_a_connection() {
    let mut bus = bus_with_history();
    bus.ask(Pgn::DM2, OURS);
    bus.run(5);
    let [a, b, c] = Pgn::DM2.to_bytes();
    for control in [[17, 3, 1], [255, 1, 0xFF], [19, 0, 0]] {
        let [first, second, third] = control;
        let bytes = [first, second, third, 0xFF, 0xFF, a, b, c];
        bus.hear(Pgn::TRANSPORT_CONNECTION, OURS, 0x30, &bytes);
    }
    bus.run(50);
    assert_eq!(packets(&mut bus), [0; 0]);
    management(&mut bus, [17, 1, 1, 0xFF, 0xFF]);
    bus.run(50);
    assert_eq!(packets(&mut bus), [1]);
}

#[test]
fn the_software_says_what_it_is() {
    let mut bus = Bus::claimed(Variant::Iso11783);
    bus.ask(Pgn::SOFTWARE_IDENTIFICATION, 0xFF);
    bus.run(200);
    let text = reassembled(&bus.sent, Pgn::SOFTWARE_IDENTIFICATION);
    assert_eq!(text, b"\x01hitch 1*");
}

#[test]
fn who_asks_everybody_gets_the_answer_after_the_broadcast_under_way() {
    let mut bus = bus_with_history();
    bus.status.troubles = troubles(&[Trouble::SupplyLow, Trouble::LeverHigh]);
    bus.run(20);
    assert_eq!(bus.take(Pgn::TRANSPORT_CONNECTION).len(), 1, "DM1 begins");
    bus.ask(Pgn::DM2, 0xFF);
    bus.run(2_500);
    let group = |sent: &Sent| Pgn::from_bytes(*sent.data()[5..].first_chunk().unwrap());
    let begun = bus.take(Pgn::TRANSPORT_CONNECTION);
    assert_eq!(group(&begun[0]), Pgn::DM2);
    assert!(
        begun.iter().skip(1).all(|sent| group(sent) == Pgn::DM1),
        "once"
    );
}
