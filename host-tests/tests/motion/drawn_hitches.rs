//! The controller without teaching on unknown hitches: drawn, driven, and tabulated.
//!
//! `cargo run --release -p host-tests --example drive-drawn-hitches` runs many more.

use hitch_quantities::Calibration;
use host_tests::seeds::cases;
use truth_rigs::drawn_hitches::draw::{Drawn, draw};
use truth_rigs::drawn_hitches::figures::{FIGURES, beyond, spread, table, worst};
use truth_rigs::drawn_hitches::session::{MoveFigures, drive};
use truth_rigs::second_rig::physics::SpoolMotion;

/// How many machines of a kind by day, and with `HITCH_THOROUGH`.
const FEW_MACHINES: usize = 15;
const MACHINES: usize = 40;

/// How many moves each.
const MOVES: usize = 4;

/// Limits for a kind of machine; final errors, pressure swings and faults have the same limits everywhere.
struct Bars {
    /// Median of time over shortest, and 95 % quantile.
    ratio: [f64; 2],
    /// Share of the moves that overshoot by more than 0.3 degree.
    overshooting: f64,
    /// Largest overshoot, degree.
    overshoot_deg: f64,
    /// Share of the moves with a final error above 0.3 degree.
    off: f64,
}

#[test]
fn an_untaught_machine_moves_well_whatever_it_is() {
    let bars = Bars {
        ratio: [1.15, 1.7],
        overshooting: 0.1,
        overshoot_deg: 1.0,
        off: 0.0,
    };
    drive_all("textbook machines", false, &bars);
}

/// Structured machines have effects outside the controller's models; their loads oscillate on compensators with lag.
#[test]
fn a_load_that_oscillates_on_its_compensator_is_lifted_gently() {
    let bars = Bars {
        ratio: [1.4, 2.5],
        overshooting: 0.15,
        overshoot_deg: 1.2,
        off: 0.03,
    };
    drive_all("structured machines", true, &bars);
}

/// The estimate assumes spools of first order. Its error with a spool of second order must not cause oscillation about the
/// set point, which would be reported as a leak.
#[test]
fn a_slow_second_order_spool_causes_no_limit_cycle() {
    let machines: Vec<Drawn> = (1..)
        .take(cases(FEW_MACHINES, MACHINES))
        .map(|seed| {
            draw(seed, MOVES).with_spool(SpoolMotion::Swinging {
                frequency_rad_s: 30.0,
                damping: 0.7,
                dead_time_s: 0.004,
            })
        })
        .collect();
    let moves = driven("machines with slow spools", &machines);
    let all: Vec<&MoveFigures> = moves.iter().collect();
    let [_, _, error, _, _, fault] = &FIGURES;
    assert_eq!(beyond(&all, fault), 0.0);
    assert!(spread(&all, error.of)[2] <= 0.5);
}

/// The moves of some machines with the nominal calibration, printed with the worst of them.
fn driven(title: &str, machines: &[Drawn]) -> Vec<MoveFigures> {
    let calibration = Calibration::nominal().validate().unwrap();
    let moves: Vec<MoveFigures> = machines
        .iter()
        .flat_map(|machine| drive(machine, &calibration))
        .collect();
    let all: Vec<&MoveFigures> = moves.iter().collect();
    println!("{}", table(title, &all));
    println!("{}", worst(&moves, machines, 3));
    moves
}

fn drive_all(title: &str, structured: bool, bars: &Bars) {
    let machines: Vec<Drawn> = (1..)
        .map(|seed| draw(seed, MOVES))
        .filter(|machine| machine.structured == structured)
        .take(cases(FEW_MACHINES, MACHINES))
        .collect();
    let moves = driven(title, &machines);
    let all: Vec<&MoveFigures> = moves.iter().collect();
    let [ratio, overshoot, error, swing, restarts, fault] = &FIGURES;
    let [median, high, _] = spread(&all, ratio.of);
    assert!(
        median <= bars.ratio[0],
        "median of time over shortest {median}"
    );
    assert!(high <= bars.ratio[1], "95 % quantile {high}");
    assert!(beyond(&all, overshoot) <= bars.overshooting);
    assert!(spread(&all, overshoot.of)[2] <= bars.overshoot_deg);
    assert!(beyond(&all, error) <= bars.off);
    assert_eq!(beyond(&all, swing), 0.0);
    assert!(beyond(&all, restarts) <= 0.04);
    assert_eq!(beyond(&all, fault), 0.0);
}
