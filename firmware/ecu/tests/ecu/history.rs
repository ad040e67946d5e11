//! Trouble codes over a restart, from converter codes to DM2.

use hitch_ecu::{AdcCode, Contacts};
use hitch_protocols::j1939::Pgn;
use hitch_quantities::State;

use crate::bench::{Bench, Flash};
use crate::engine::{of_the_board, stored};

/// Time after which the ECU has its address and the operator's controls are believed, ms.
const READY_MS: u32 = 600;
/// SPN 520 192, FMI 31: the lever is missing.
const LEVER_MISSING: [u8; 3] = [0x00, 0xF0, 0xFF];
/// SPN 168, FMI 4: the supply is low.
const SUPPLY_LOW: [u8; 3] = [168, 0, 4];

fn lever_off(contacts: &mut Contacts) {
    contacts.samples.lever = AdcCode::new(0);
}

/// 6 V.
fn supply_low(contacts: &mut Contacts) {
    contacts.samples.supply = AdcCode::new(1_000);
}

/// An ECU without another trouble than those that a test makes: it has a calibration.
fn start(flash: &Flash) -> Bench {
    let mut bench = Bench::start(flash.clone());
    bench.run(READY_MS);
    bench
}

fn delivered() -> Flash {
    stored(of_the_board())
}

/// The lever's wire breaks for a while.
fn lever_breaks(bench: &mut Bench, ms: u32) {
    (0..ms).for_each(|_| {
        bench.step_with(lever_off);
    });
}

/// Asks for a group of at most one trouble code, or to clear the codes; the answer's first code and count.
fn ask(bench: &mut Bench, group: Pgn) -> Option<([u8; 3], u8)> {
    bench.sent.clear();
    let [a, b, c] = group.to_bytes();
    bench.receive(Pgn::REQUEST, 0x26, [a, b, c, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF]);
    bench.run(20);
    let answer = bench.sent.iter().find_map(|(_, frame)| {
        let id = hitch_protocols::j1939::Id::unpack(frame.extended_data_id()?);
        (id.pgn == group).then(|| frame.data().to_vec())
    })?;
    let &[_, _, a, b, c, count, ..] = answer.as_slice() else {
        panic!("{answer:?}");
    };
    (count > 0).then_some(([a, b, c], count))
}

#[test]
fn a_fault_is_previously_active_after_a_restart_and_counted_on() {
    let flash = delivered();
    for starts in 1..=3 {
        let mut bench = start(&flash);
        let before = (starts > 1).then_some((LEVER_MISSING, starts - 1));
        assert_eq!(ask(&mut bench, Pgn::DM2), before);
        lever_breaks(&mut bench, 50);
        // Power fails while it is still active.
    }
}

#[test]
fn several_occurrences_in_one_start_are_one_entry() {
    let flash = delivered();
    let mut bench = start(&flash);
    for _ in 0..5 {
        lever_breaks(&mut bench, 50);
        bench.run(1_000);
    }
    assert_eq!(ask(&mut bench, Pgn::DM2), Some((LEVER_MISSING, 5)));
    assert_eq!(ask(&mut start(&flash), Pgn::DM2), Some((LEVER_MISSING, 1)));
}

#[test]
fn what_is_cleared_stays_cleared() {
    let flash = delivered();
    lever_breaks(&mut start(&flash), 50);
    let mut bench = start(&flash);
    ask(&mut bench, Pgn::DM3);
    assert_eq!(ask(&mut bench, Pgn::DM2), None);
    let mut bench = start(&flash);
    assert_eq!(ask(&mut bench, Pgn::DM2), None);
    lever_breaks(&mut bench, 50);
    assert_eq!(ask(&mut start(&flash), Pgn::DM2), Some((LEVER_MISSING, 1)));
}

#[test]
fn a_supply_that_goes_away_is_no_fault_of_the_past_and_one_that_comes_back_is() {
    let flash = delivered();
    let goes_away = |bench: &mut Bench| {
        (0..200).for_each(|_| {
            bench.step_with(supply_low);
        });
    };
    goes_away(&mut start(&flash));
    let mut bench = start(&flash);
    assert_eq!(ask(&mut bench, Pgn::DM2), None);
    goes_away(&mut bench);
    bench.run(100);
    assert_eq!(ask(&mut start(&flash), Pgn::DM2), Some((SUPPLY_LOW, 1)));
}

#[test]
fn nothing_is_written_while_the_hitch_moves() {
    let flash = delivered();
    lever_breaks(&mut start(&flash), 50);
    let mut bench = start(&flash);
    bench.pick_up(130_000);
    assert_eq!(bench.run(300), State::Lifting);
    let before = flash.all_bytes();
    ask(&mut bench, Pgn::DM3);
    assert_eq!(bench.state(), State::Lifting);
    assert_eq!(flash.all_bytes(), before, "while it lifts");
    assert_eq!(ask(&mut start(&flash), Pgn::DM2), Some((LEVER_MISSING, 1)));
    bench.panel = bench.panel.with(hitch_ecu::Contact::FieldMode, false);
    bench.run(100);
    assert_ne!(flash.all_bytes(), before, "once it is locked");
    assert_eq!(ask(&mut start(&flash), Pgn::DM2), None);
}
