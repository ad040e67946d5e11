//! Valves with a hysteresis of 0.12 to 0.2 A: after teaching, motion is as accurate as with other valves.
//!
//! The machines are those of the second rig, whose hysteresis is not reduced by dither.

use std::sync::LazyLock;

use hitch_quantities::{Calibration, ValidCalibration};
use host_tests::seeds::cases;
use truth_rigs::drawn_hitches::draw::{Drawn, draw};
use truth_rigs::drawn_hitches::figures::{FIGURES, beyond, spread, table, worst};
use truth_rigs::drawn_hitches::session::{MoveFigures, drive};
use truth_rigs::drawn_hitches::teaching::taught;
use truth_rigs::second_rig::driven_hitch::Conditions;

/// By day, and with `HITCH_THOROUGH`.
const FEW_MACHINES: usize = 12;
const MACHINES: usize = 40;
const MOVES: usize = 6;
/// Narrowest hysteresis that is wide, A.
const WIDE_A: f64 = 0.12;

fn width_a(drawn: &Drawn) -> f64 {
    drawn
        .physics
        .plays
        .iter()
        .map(|play| 2.0 * play.half_width_a * play.share)
        .sum()
}

/// Textbook machines with wide hysteresis, and the results of teaching.
static TAUGHT_MACHINES: LazyLock<Vec<(Drawn, ValidCalibration)>> = LazyLock::new(taught_machines);

fn taught_machines() -> Vec<(Drawn, ValidCalibration)> {
    let nominal = Calibration::nominal().validate().unwrap();
    let wide = |drawn: &Drawn| !drawn.structured && width_a(drawn) >= WIDE_A;
    let machines = (1..).map(|seed| draw(seed, MOVES)).filter(wide);
    let taught = machines.take(cases(FEW_MACHINES, MACHINES)).map(|drawn| {
        let calibration = taught(&drawn, &nominal)
            .unwrap_or_else(|error| panic!("machine {}: {error:?}", drawn.seed));
        (drawn, calibration)
    });
    taught.collect()
}

// REQ-MOTION-05
#[test]
fn the_hysteresis_of_the_valves_is_found() {
    let mut off = Vec::new();
    for (drawn, calibration) in TAUGHT_MACHINES.iter() {
        let found_a = f64::from(calibration.hydraulics.hysteresis.0) * 1e-3;
        let true_a = width_a(drawn);
        let hydraulics = &calibration.hydraulics;
        let lags = [hydraulics.spool_lag, hydraulics.lower_spool_lag].map(|lag| lag.0);
        let Conditions {
            load_kg,
            oil_temperature_c,
            spool_lag_s,
        } = drawn.conditions;
        println!(
            "machine {:3} at {:3.0} deg: {true_a:.3} A, found {found_a:.3} A; {load_kg:3.0} kg, \
             {oil_temperature_c:2.0} C, pressures {}, spools of {:.0} ms, found {lags:?}",
            drawn.seed,
            drawn.angles_deg[0],
            drawn.readings.pressures,
            1e3 * spool_lag_s
        );
        if (found_a - true_a).abs() > 0.02 {
            off.push((drawn.seed, true_a, found_a));
        }
    }
    assert!(off.is_empty(), "{off:?}");
}

#[test]
fn a_taught_hitch_moves_well_on_valves_with_wide_hysteresis() {
    let moves: Vec<MoveFigures> = TAUGHT_MACHINES
        .iter()
        .flat_map(|(drawn, calibration)| drive(drawn, calibration))
        .collect();
    let machines = TAUGHT_MACHINES.iter().map(|(drawn, _)| drawn.clone());
    let machines: Vec<Drawn> = machines.collect();
    let all: Vec<&MoveFigures> = moves.iter().collect();
    println!("{}", table("taught machines with wide hysteresis", &all));
    println!("{}", worst(&moves, &machines, 3));
    let [ratio, overshoot, error, swing, restarts, fault] = &FIGURES;
    let [median, high, _] = spread(&all, ratio.of);
    assert!(median <= 1.15, "median of time over shortest {median}");
    assert!(high <= 1.4, "95 % quantile {high}");
    assert!(beyond(&all, overshoot) <= 0.02);
    assert!(spread(&all, overshoot.of)[2] <= 0.5);
    for figure in [error, swing, restarts, fault] {
        assert_eq!(beyond(&all, figure), 0.0);
    }
}

/// Near an end, teaching must not attribute the end stop to the valve.
#[test]
fn wherever_teaching_begins_it_finds_the_same() {
    let nominal = Calibration::nominal().validate().unwrap();
    for &seed in cases(&[2][..], &[2, 98, 127, 134]) {
        for from_deg in [45.0, 52.0, 90.0, 128.0, 135.0] {
            let mut drawn = draw(seed, MOVES);
            drawn.angles_deg[0] = from_deg;
            let hydraulics = &taught(&drawn, &nominal).unwrap().hydraulics;
            let lags = [hydraulics.spool_lag, hydraulics.lower_spool_lag].map(|lag| lag.0);
            let found_a = f64::from(hydraulics.hysteresis.0) * 1e-3;
            println!("machine {seed} from {from_deg} deg: {found_a:.3} A, {lags:?} ms");
            assert!((found_a - width_a(&drawn)).abs() <= 0.02);
            for lag_ms in lags {
                let true_ms = 1e3 * drawn.conditions.spool_lag_s;
                assert!((f64::from(lag_ms) - true_ms).abs() <= 5.0, "{true_ms} ms");
            }
        }
    }
}
