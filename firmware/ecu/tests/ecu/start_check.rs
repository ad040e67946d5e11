//! What the board has found at its start.

use hitch_ecu::StartCheck;
use hitch_protocols::j1939::Trouble;
use hitch_quantities::State;

use crate::bench::{Bench, Flash};

#[test]
fn a_trouble_that_locks_keeps_both_coils_off_whatever_the_operator_does() {
    let mut bench = Bench::start(Flash::blank());
    let mut check = StartCheck::default();
    check.lock(Trouble::Crystal);
    bench.machine.report(check);
    assert!(bench.is_still(50));
    for lever in [80_000, 110_000, 90_000, 120_000] {
        bench.lever = lever;
        assert!(bench.is_still(500), "lever at {lever}");
    }
    assert_eq!(bench.state(), State::TransportLock);
}

#[test]
fn a_trouble_that_is_only_noted_locks_nothing() {
    let mut bench = Bench::start(Flash::blank());
    let mut check = StartCheck::default();
    check.note(Trouble::ImageForDebugging);
    bench.machine.report(check);
    bench.run(20);
    bench.pick_up(110_000);
    assert_eq!(bench.run(300), State::Lifting);
}
