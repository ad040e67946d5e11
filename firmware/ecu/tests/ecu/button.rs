//! The external buttons of the running application: presses, shorted wires, and their trouble codes.

use hitch_ecu::{Contact, Panel};
use hitch_quantities::units::Count;
use hitch_quantities::{Calibration, State};

use crate::bench::{Bench, Flash};
use crate::engine::stored;
use crate::key::has_code;

const BUTTONS: u32 = 520_192 + 13;
const CLOSED: u8 = 4;
const CONTRADICTING: u8 = 2;

/// A machine whose buttons have one contact each.
fn one_contact() -> Flash {
    let mut block = Calibration::nominal();
    block.operator.second_contact = Count(0);
    stored(block)
}

/// The hitch rests where it was captured.
fn in_operation(flash: Flash) -> Bench {
    let mut bench = Bench::start(flash);
    bench.run(300);
    bench.pick_up(90_000);
    bench.run(2_000);
    assert_eq!(bench.state(), State::Holding);
    bench
}

/// How far the hitch goes while the panel is like this, thousandths of a degree.
fn moved(bench: &mut Bench, panel: Panel, ms: u32) -> i32 {
    let from = bench.angle();
    bench.panel = panel;
    bench.run(ms);
    bench.angle() - from
}

// REQ-SAFE-16
#[test]
fn a_wire_that_is_shorted_for_8_s_moves_the_hitch_by_one_press_at_most() {
    for (contact, sign) in [(Contact::Up, 1), (Contact::Down, -1)] {
        let mut bench = in_operation(one_contact());
        let shorted = Panel::FIELD.with(contact, true);
        let travel = sign * moved(&mut bench, shorted, 8_000);
        println!("{contact:?}: {travel} thousandths of a degree");
        assert!((20_000..=30_000).contains(&travel), "{travel}");
        assert!(has_code(&mut bench, BUTTONS, CLOSED), "DM1");
        assert!(bench.is_still(1_000), "closed ever since");
        assert_eq!(moved(&mut bench, Panel::FIELD, 500), 0);
        let next = sign * moved(&mut bench, shorted, 500);
        assert!(next > 0, "a press after a release: {next}");
    }
}

// REQ-SAFE-16
#[test]
fn a_shorted_wire_moves_nothing_if_the_button_has_two_contacts() {
    for contact in [Contact::Up, Contact::Down] {
        let mut bench = in_operation(Flash::blank());
        bench.panel = Panel::FIELD.with(contact, true);
        assert!(bench.is_still(8_000), "{contact:?}");
        assert!(has_code(&mut bench, BUTTONS, CONTRADICTING), "DM1");
        bench.panel = Panel::FIELD;
        bench.run(100);
        let up = Panel::FIELD.with_buttons(true, false);
        assert!(moved(&mut bench, up, 1_000) > 2_000, "a press");
    }
}

#[test]
fn a_press_moves_the_hitch_both_ways_with_two_contacts() {
    for (up, sign) in [(true, 1), (false, -1)] {
        let mut bench = in_operation(Flash::blank());
        let pressed = Panel::FIELD.with_buttons(up, !up);
        let travel = sign * moved(&mut bench, pressed, 8_000);
        assert!((20_000..=30_000).contains(&travel), "{travel}");
    }
}

#[test]
fn a_button_that_is_closed_at_power_up_moves_nothing_and_is_told() {
    for (flash, panel) in [
        (one_contact(), Panel::FIELD.with(Contact::Up, true)),
        (Flash::blank(), Panel::FIELD.with_buttons(true, false)),
    ] {
        let mut bench = Bench::start(flash);
        bench.panel = panel;
        assert!(bench.is_still(2_000));
        assert!(has_code(&mut bench, BUTTONS, CLOSED), "DM1");
        assert!(bench.is_still(1_000));
    }
}

#[test]
fn the_lever_still_moves_a_hitch_whose_button_is_stuck() {
    let mut bench = Bench::start(Flash::blank());
    bench.panel = Panel::FIELD.with(Contact::Up, true);
    bench.run(500);
    bench.pick_up(110_000);
    assert!(!bench.is_still(2_000));
}
