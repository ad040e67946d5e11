//! The controller of an untaught machine on hitches that it has never met: drawn, driven, and tabulated.
//!
//! `cargo run --release -p host-tests --bin drive-drawn-hitches` does it with many more.

use hitch_firmware::control::Calibration;
use host_tests::drawn_hitches::draw::draw;
use host_tests::drawn_hitches::figures::{FIGURES, beyond, spread, table, worst};
use host_tests::drawn_hitches::session::{MoveFigures, drive};

/// Machines whose effects are of the textbooks' simplest form; the structured ones are what no controller has been made for.
const MACHINES: usize = 40;
const MOVES: usize = 4;

#[test]
fn an_untaught_machine_moves_well_whatever_it_is() {
    let calibration = Calibration::nominal().validate().unwrap();
    let machines: Vec<_> = (1..)
        .map(|seed| draw(seed, MOVES))
        .filter(|machine| !machine.structured)
        .take(MACHINES)
        .collect();
    let moves: Vec<MoveFigures> = machines
        .iter()
        .flat_map(|machine| drive(machine, &calibration))
        .collect();
    let all: Vec<&MoveFigures> = moves.iter().collect();
    println!("{}", table("untaught machines", &all));
    println!("{}", worst(&moves, &machines, 3));
    let [ratio, overshoot, error, swing, restarts, fault] = &FIGURES;
    let [median, high, _] = spread(&all, ratio.of);
    assert!(median <= 1.15, "median of time over shortest {median}");
    assert!(high <= 1.7, "95 % below {high}");
    assert!(beyond(&all, overshoot) <= 0.1 && spread(&all, overshoot.of)[2] <= 1.0);
    assert_eq!(beyond(&all, error), 0.0);
    assert_eq!(beyond(&all, swing), 0.0);
    assert!(beyond(&all, restarts) <= 0.04);
    assert_eq!(beyond(&all, fault), 0.0);
}
