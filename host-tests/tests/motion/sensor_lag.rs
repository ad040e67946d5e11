//! Moves with an angle sensor that lags: with its lag in the calibration they end as with a fast sensor.
//!
//! All figures are those of the true angle.

use hitch_closed_loop::ClosedLoop;
use hitch_closed_loop::calibrate::calibrate;
use hitch_effects::find;
use hitch_plant::{AddedEffect, Currents, Model};
use hitch_quantities::units::{MilliDegree, Millisecond};
use hitch_quantities::{Calibration, Fault, ValidCalibration};
use truth_rigs::drawn_hitches::draw::draw;
use truth_rigs::drawn_hitches::figures::{FIGURES, beyond, spread, table};
use truth_rigs::drawn_hitches::session::{MoveFigures, drive as drive_drawn};

const LOAD_KG: f64 = 150.0;
const OIL_C: f64 = 40.0;
const SEED: u64 = 7;
/// From the step of the lever, ms.
const WATCHED_MS: usize = 6_000;
/// Up and down by 30, 55 and 5 degrees.
const MOVES_DEG: [(f64, f64); 6] = [
    (70.0, 100.0),
    (100.0, 70.0),
    (65.0, 120.0),
    (120.0, 65.0),
    (85.0, 90.0),
    (90.0, 85.0),
];
/// Distance to the set point at which a move has arrived, degree.
const ARRIVED_DEG: f64 = 0.5;

/// Figures of a move.
#[derive(Clone, Copy, Debug)]
struct Figures {
    settling_s: f64,
    overshoot_deg: f64,
    final_error_deg: f64,
    fault: Option<Fault>,
}

/// The dynamic machine with an angle sensor that lags.
fn machine(lag_s: f64) -> Model {
    let mut added = AddedEffect::typical(find("angle-sensor-lag").unwrap());
    added.values[0] = lag_s;
    let effects = if lag_s > 0.0 { vec![added] } else { Vec::new() };
    hitch_model_file::dynamic().with_effects(effects)
}

fn calibration(lag_ms: i32) -> ValidCalibration {
    let mut calibration = Calibration::nominal();
    calibration.sensors.angle_lag = Millisecond(lag_ms);
    calibration.sealed().validate().unwrap()
}

fn drive(model: &Model, calibration: &ValidCalibration, (from_deg, to_deg): (f64, f64)) -> Figures {
    let mut closed_loop = ClosedLoop::new(model, calibration, LOAD_KG, OIL_C, from_deg, SEED);
    closed_loop.pick_up();
    let mut figures = Figures {
        settling_s: 0.0,
        overshoot_deg: 0.0,
        final_error_deg: 0.0,
        fault: None,
    };
    for ms in 0..WATCHED_MS {
        let sample = closed_loop.step(to_deg);
        let error_deg = sample.angle_deg - to_deg;
        let beyond_deg = error_deg * (to_deg - from_deg).signum();
        figures.overshoot_deg = figures.overshoot_deg.max(beyond_deg);
        if error_deg.abs() > ARRIVED_DEG {
            figures.settling_s = (ms + 1) as f64 * 1e-3;
        }
        figures.final_error_deg = error_deg.abs();
        figures.fault = figures.fault.or(sample.outputs.fault);
    }
    figures
}

/// The six moves of a machine whose sensor lags by `lag_s`, with `lag_ms` in the calibration.
fn six_moves(lag_s: f64, lag_ms: i32) -> [Figures; 6] {
    let (model, calibration) = (machine(lag_s), calibration(lag_ms));
    let moves = MOVES_DEG.map(|way| drive(&model, &calibration, way));
    let cells = moves.map(|figures| {
        let fault = figures.fault.map_or("", Fault::name);
        format!(
            "{:.2}/{:.2}{fault}",
            figures.settling_s, figures.overshoot_deg
        )
    });
    println!(
        "lag {lag_s:.3} s, calibrated {lag_ms:3} ms, settling s / overshoot deg: {}",
        cells.join(" ")
    );
    moves
}

/// All six arrive without a fault, within a time and an overshoot.
fn arrive(moves: &[Figures], longest_s: f64, overshoot_deg: f64) {
    for (figures, way) in moves.iter().zip(MOVES_DEG) {
        assert_eq!(figures.fault, None, "{way:?}");
        assert!(
            figures.final_error_deg <= ARRIVED_DEG,
            "{way:?}: {figures:?}"
        );
        assert!(figures.settling_s <= longest_s, "{way:?}: {figures:?}");
        assert!(
            figures.overshoot_deg <= overshoot_deg,
            "{way:?}: {figures:?}"
        );
    }
}

// REQ-MOTION-01
#[test]
fn a_hitch_whose_angle_sensor_lags_as_calibrated_arrives_as_with_a_fast_one() {
    arrive(&six_moves(0.0, 0), 1.5, 0.3);
    arrive(&six_moves(0.189, 189), 1.5, 0.3);
    arrive(&six_moves(0.350, 350), 1.5, 0.5);
}

#[test]
fn short_lags_are_served_as_well() {
    for lag_ms in [1, 3, 10, 30, 60] {
        arrive(&six_moves(1e-3 * f64::from(lag_ms), lag_ms), 1.5, 0.3);
    }
}

#[test]
fn a_lag_that_is_calibrated_too_long_costs_time_only() {
    arrive(&six_moves(0.189, 227), 3.0, 0.3);
    arrive(&six_moves(0.0, 50), 3.0, 0.3);
}

/// Without the calibration the same sensor makes the position oscillate: what the others show is due to it.
#[test]
fn a_lag_that_the_calibration_does_not_know_is_no_such_motion() {
    let moves = six_moves(0.189, 0);
    assert!(
        moves
            .iter()
            .any(|figures| figures.fault.is_some() || figures.overshoot_deg > 3.0)
    );
}

/// The sensor still shows the first motion when the coil of the second is switched on.
#[test]
fn a_move_that_is_reversed_under_way_trips_nothing() {
    for lag_ms in [189, 350] {
        let (model, calibration) = (machine(1e-3 * f64::from(lag_ms)), calibration(lag_ms));
        for (from_deg, to_deg) in [(65.0, 120.0), (120.0, 65.0)] {
            for reversed_ms in [200, 400, 600, 900] {
                let mut closed_loop =
                    ClosedLoop::new(&model, &calibration, LOAD_KG, OIL_C, from_deg, SEED);
                closed_loop.pick_up();
                let mut last_deg = from_deg;
                for ms in 0..WATCHED_MS {
                    let lever_deg = if ms < reversed_ms { to_deg } else { from_deg };
                    let sample = closed_loop.step(lever_deg);
                    last_deg = sample.angle_deg;
                    let fault = sample.outputs.fault;
                    assert_eq!(
                        fault, None,
                        "{lag_ms} ms, to {to_deg}, {reversed_ms} ms, {ms} ms"
                    );
                }
                assert!(
                    (last_deg - from_deg).abs() <= ARRIVED_DEG,
                    "{lag_ms} ms, to {to_deg}, {reversed_ms} ms: {last_deg} deg"
                );
            }
        }
    }
}

/// Largest distance from the place at `instant_ms` of a move, whose angle then freezes, or whose coils are cut.
fn travel_deg(
    model: &Model,
    calibration: &ValidCalibration,
    (from_deg, to_deg): (f64, f64),
    instant_ms: usize,
    frozen: bool,
) -> f64 {
    let mut closed_loop = ClosedLoop::new(model, calibration, LOAD_KG, OIL_C, from_deg, SEED);
    closed_loop.pick_up();
    let (mut start_deg, mut shown, mut most_deg) = (from_deg, None, 0.0_f64);
    for _ in 0..instant_ms {
        let sample = closed_loop.step(to_deg);
        (start_deg, shown) = (sample.angle_deg, sample.inputs.rocker_angle);
    }
    // Trembles, so that the row for an unchanged sample does not see it.
    let mut noise = fastrand::Rng::with_seed(SEED);
    for _ in 0..2_000 {
        let sample = closed_loop.step_with(
            to_deg,
            |inputs| {
                if frozen {
                    let by = MilliDegree(noise.i32(-50..=50));
                    inputs.rocker_angle = shown.map(|angle| angle + by);
                }
            },
            |_, currents| {
                if !frozen {
                    *currents = Currents::default();
                }
            },
        );
        most_deg = most_deg.max((sample.angle_deg - start_deg).abs());
    }
    most_deg
}

// REQ-SAFE-04
/// The bound is that of drawn machines without lag.
#[test]
fn a_frozen_angle_that_lagged_costs_no_more_travel_than_is_stated() {
    const MOST_DEG: f64 = 23.3;
    for lag_ms in [0, 50, 100, 189, 350, 480] {
        let (model, calibration) = (machine(1e-3 * f64::from(lag_ms)), calibration(lag_ms));
        let mut worst = (0.0, 0.0, 0);
        for way in [(60.0, 120.0), (120.0, 60.0)] {
            for instant_ms in (35..600).step_by(35) {
                let of = |frozen| travel_deg(&model, &calibration, way, instant_ms, frozen);
                let extra_deg = of(true) - of(false);
                if extra_deg > worst.0 {
                    worst = (extra_deg, way.1, instant_ms);
                }
            }
        }
        let (extra_deg, to_deg, instant_ms) = worst;
        println!("lag {lag_ms} ms: {extra_deg:.2} deg extra, to {to_deg} deg at {instant_ms} ms");
        assert!(extra_deg <= MOST_DEG, "{lag_ms} ms: {extra_deg} deg");
    }
}

#[test]
fn the_lag_of_an_identified_model_goes_to_the_calibration() {
    let of =
        |lag_s| calibrate(&machine(lag_s), &Calibration::nominal()).map(|c| c.sensors.angle_lag);
    assert_eq!(of(0.0).unwrap(), Millisecond(0));
    assert_eq!(of(0.189).unwrap(), Millisecond(189));
    let refused = of(0.6).unwrap_err().to_string();
    assert!(refused.contains("angle_lag"), "{refused}");
}

/// Untaught machines of the second rig, whose sensors lag by 20 to 350 ms as their calibrations have it.
///
/// A load that oscillates on a compensator with lag overshoots: the spool lag, by which such a lag is found with a fast
/// sensor, is not identified. So the overshoot is only judged of the other machines.
#[test]
fn drawn_hitches_with_lag_arrive_without_a_fault() {
    const MACHINES: u64 = 12;
    const MOVES: usize = 4;
    let mut lags = fastrand::Rng::with_seed(SEED);
    let (mut quick, mut oscillating) = (Vec::new(), Vec::new());
    for seed in 1..=MACHINES {
        let lag_ms = lags.i32(20..=350);
        let mut machine = draw(seed, MOVES);
        machine.physics.sensors.angle_lag_s = 1e-3 * f64::from(lag_ms);
        let moves = drive_drawn(&machine, &calibration(lag_ms));
        if machine.physics.compensator_lag_s > 0.0 {
            oscillating.extend(moves)
        } else {
            quick.extend(moves)
        }
    }
    let [_, overshoot, error, _, _, fault] = &FIGURES;
    for (title, moves) in [
        ("drawn hitches with lag", &quick),
        ("... and a compensator with lag", &oscillating),
    ] {
        let all: Vec<&MoveFigures> = moves.iter().collect();
        println!("{}", table(title, &all));
        assert_eq!(beyond(&all, fault), 0.0);
        assert!(spread(&all, error.of)[2] <= ARRIVED_DEG);
    }
    let all: Vec<&MoveFigures> = quick.iter().collect();
    let [_, high_deg, _] = spread(&all, overshoot.of);
    assert!(high_deg <= ARRIVED_DEG, "95 % quantile {high_deg} deg");
}
