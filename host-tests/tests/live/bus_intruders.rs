//! A node of the bus, a tool and a shorted wire, without the operator's consent: the hitch stays where it is.
//!
//! Each row is a function of `bus_intruders.py`, with python-can and pyxcp against the application on the host. The rocker
//! angle is that of the plant, not what the ECU reports.

use hitch_ecu::BoardScaling;
use hitch_ecu_host::ecu::{CutFlash, OnHost, delivered};
use hitch_quantities::calibration::fitted::Fitted;
use hitch_quantities::{Calibration, ValidCalibration};
use host_tests::live_ecu::{Operator, START_DEG};

use crate::python_clients::run_client;

/// Largest travel of a hitch that stays, degree.
const STAYS_DEG: f64 = 1.0;
/// Largest travel of a press of the button, degree.
const PRESS_DEG: f64 = 30.0;

fn monitoring(fitted: Fitted) -> ValidCalibration {
    let mut block = Calibration::nominal();
    block.monitor(fitted);
    block.seal().unwrap()
}

/// Runs a row; asserts the range of the rocker angle, relative to the start.
fn row(name: &str, operator: Operator, fitted: Fitted, range_deg: [f64; 2], expected: &[&str]) {
    let flash = delivered(&monitoring(fitted));
    let start = move || OnHost::start(CutFlash::holding(flash));
    let kept = format!("kept: {name}");
    let expected: Vec<&str> = expected.iter().copied().chain([kept.as_str()]).collect();
    let script = ["bus_intruders.py", name];
    let Some([lowest_deg, highest_deg]) = run_client(&script, start, operator, &expected) else {
        return;
    };
    let travel_deg = [lowest_deg - START_DEG, highest_deg - START_DEG];
    println!("{name}: {:.2} to {:.2} deg", travel_deg[0], travel_deg[1]);
    assert!(
        travel_deg[0] >= range_deg[0] && travel_deg[1] <= range_deg[1],
        "{travel_deg:?}"
    );
}

fn stays(name: &str, operator: Operator, expected: &[&str]) {
    let range_deg = [-STAYS_DEG, STAYS_DEG];
    row(
        name,
        operator,
        BoardScaling::NOMINAL.fitted,
        range_deg,
        expected,
    );
}

// REQ-MODE-11
#[test]
fn a_node_without_an_address_claim_moves_nothing() {
    stays("unclaimed_node", Operator::Withholding, &[]);
}

// REQ-MODE-11
#[test]
fn a_hitch_whose_address_is_taken_stays() {
    stays("hitch_without_address", Operator::Withholding, &[]);
}

// REQ-SAFE-14
#[test]
fn a_lower_limit_above_the_hitch_does_not_lift_it() {
    stays("lower_limit_as_lever", Operator::Withholding, &[]);
}

// REQ-SAFE-14
#[test]
fn an_upper_limit_neither_lowers_the_hitch_nor_lets_the_lever_reach_the_end_stop() {
    let limit_deg = f64::from(Calibration::nominal().position.upper_limit.0) * 1e-3;
    let range_deg = [-STAYS_DEG, limit_deg + 0.5 - START_DEG];
    let fitted = BoardScaling::NOMINAL.fitted;
    row(
        "upper_limit_as_lever",
        Operator::Lifting,
        fitted,
        range_deg,
        &[],
    );
}

// REQ-SAFE-11
#[test]
fn no_safety_value_goes_to_its_loosest_end() {
    let expected = ["accepted: 0 of "];
    stays("loosest_safety_values", Operator::OnRoad, &expected);
}

// REQ-SAFE-08
#[test]
fn an_engine_speed_of_anybody_locks_nothing_and_a_lost_one_is_reported() {
    stays("engine_speed_of_anybody", Operator::Withholding, &[]);
}

// REQ-SAFE-16
#[test]
fn a_shorted_wire_of_a_button_with_two_contacts_moves_nothing() {
    stays("shorted_wire_of_two_contacts", Operator::WireShorted, &[]);
}

// REQ-SAFE-16
#[test]
fn a_shorted_wire_of_a_button_with_one_contact_moves_the_hitch_by_one_press() {
    let fitted = Fitted {
        second_contact: false,
        ..BoardScaling::NOMINAL.fitted
    };
    let range_deg = [-STAYS_DEG, PRESS_DEG + STAYS_DEG];
    row(
        "shorted_wire_of_one_contact",
        Operator::WireShorted,
        fitted,
        range_deg,
        &[],
    );
}
