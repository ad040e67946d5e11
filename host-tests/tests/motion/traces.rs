//! Coverage of the traces: they reach every state and most faults, and are stored without loss.

use std::collections::BTreeSet;

use hitch_quantities::{Inputs, Outputs};
use host_tests::{replay, trace};

fn names(outputs: &[Outputs]) -> (BTreeSet<&'static str>, BTreeSet<&'static str>) {
    let states = outputs.iter().map(|outputs| outputs.state.name()).collect();
    let faults = outputs
        .iter()
        .filter_map(|outputs| Some(outputs.fault?.name()))
        .collect();
    (states, faults)
}

#[test]
fn the_recorded_trace_is_long_and_busy() {
    let recorded = trace::recorded().unwrap();
    assert!(recorded.len() >= 10_000, "only {} steps", recorded.len());
    let outputs = replay::replay(&recorded);
    let (states, faults) = names(&outputs);
    println!(
        "{} steps, states {states:?}, faults {faults:?}",
        recorded.len()
    );
    for state in [
        "locked", "holding", "lifting", "lowering", "settling", "fault",
    ] {
        assert!(
            states.contains(state),
            "the trace never gets to {state}, only to {states:?}"
        );
    }
    for fault in ["lever", "angle"] {
        assert!(
            faults.contains(fault),
            "the trace never gets to fault {fault}, only to {faults:?}"
        );
    }
    let share = |on: fn(&Outputs) -> bool| {
        outputs.iter().filter(|outputs| on(outputs)).count() * 100 / outputs.len()
    };
    let (lifting, lowering) = (
        share(|outputs| outputs.lift_current.0 > 0),
        share(|outputs| outputs.lower_current.0 > 0),
    );
    assert!(
        lifting >= 10 && lowering >= 10,
        "lifting {lifting} %, lowering {lowering} % of the time"
    );
}

#[test]
fn the_recorded_trace_has_dropouts_and_extremes() {
    let inputs: Vec<_> = trace::recorded()
        .unwrap()
        .iter()
        .map(Inputs::from_bytes)
        .collect();
    let any = |what: fn(&Inputs) -> bool| inputs.iter().any(what);
    assert!(any(
        |inputs| inputs.rocker_angle.is_none() && inputs.lever.is_some()
    ));
    assert!(any(
        |inputs| inputs.lever.is_none() && inputs.rocker_angle.is_some()
    ));
    assert!(any(
        |inputs| inputs.cylinder_pressure.is_none() && inputs.lever.is_some()
    ));
    assert!(any(|inputs| *inputs == Inputs::default()));
    assert!(any(|inputs| inputs
        .rocker_angle
        .is_some_and(|angle| angle.0 == i32::MIN)));
    assert!(any(|inputs| inputs
        .lever
        .is_some_and(|lever| lever.0 == i32::MAX)));
}

#[test]
fn random_traces_move_the_hitch_too() {
    let (states, faults) = names(&replay::replay(&trace::random(7, 50_000)));
    println!("states {states:?}, faults {faults:?}");
    assert!(
        states.contains("lifting") || states.contains("lowering"),
        "only {states:?}"
    );
    assert!(
        faults.contains("lever") && faults.contains("angle"),
        "only {faults:?}"
    );
}

#[test]
fn a_packed_trace_unpacks_to_itself() {
    for steps in [0, 1, 2, 1_000] {
        let random = trace::random(3, steps);
        assert_eq!(trace::unpack(&trace::pack(&random)).unwrap(), random);
    }
}

#[test]
fn a_damaged_trace_is_refused() {
    let packed = trace::pack(&trace::random(3, 100));
    assert!(trace::unpack(&packed[..packed.len() / 2]).is_err());
    assert!(trace::unpack(b"not a trace").is_err());
}

// REQ-MOTION-07
#[test]
fn a_single_wrong_bit_is_found() {
    let inputs = trace::random(3, 1_000);
    let host = replay::replay(&inputs);
    let mut target: Vec<_> = host.iter().map(Outputs::to_bytes).collect();
    assert_eq!(replay::first_difference(&inputs, &host, &target), None);
    target[700][17] ^= 1;
    let difference = replay::first_difference(&inputs, &host, &target).unwrap();
    assert!(difference.starts_with("step 700 of 1000"), "{difference}");
    target.pop();
    assert!(replay::first_difference(&inputs, &host, &target).is_some());
}
