//! A single angle sensor that freezes at a drawn instant causes a bounded travel, and a healthy one no trip.
//!
//! `cargo run --release -p host-tests --example freeze-the-angle` runs many more.

use hitch_quantities::Calibration;
use rayon::prelude::*;
use truth_rigs::frozen_angle::freeze::{Case, Cost};
use truth_rigs::frozen_angle::healthy::{FalseTrip, first_fault};
use truth_rigs::frozen_angle::quantiles::quantiles_deg;

/// Seeds of the freezes.
const FREEZES: std::ops::RangeInclusive<u64> = 1..=300;
/// Limits of the extra travel: median, 95 % quantile and maximum, degree.
const MOST_DEG: [f64; 3] = [3.5, 11.0, 18.0];
/// Seeds of healthy machines, a minute each.
const HEALTHY: std::ops::RangeInclusive<u64> = 1..=20;
/// Machines whose load swings on soft oil until it stands for a while.
const SWINGING: [u64; 5] = [28, 96, 1_001_206, 1_000_534, 3_000_698];
/// Machines that move by the spring of the ground, and then wait for the pressure that carries the load.
const TAKING_UP: [u64; 4] = [34, 70, 1_001_021, 1_000_398];
/// Machines lifted off the lower end stop, whose oil has no pressure.
const OFF_THE_STOP: [u64; 2] = [2_001_635, 4_002_182];
/// A machine whose pressure falls slowly as soft ground takes its weight.
const LANDING: [u64; 1] = [4_001_629];
/// A machine that bounces off soft ground at full speed.
const BOUNCING: [u64; 1] = [1_000_441];

// REQ-SAFE-04
#[test]
fn a_frozen_angle_costs_a_bounded_travel() {
    let calibration = Calibration::nominal().validate().unwrap();
    let costs: Vec<Cost> = FREEZES
        .into_par_iter()
        .map(|seed| Case::draw(seed).cost(&calibration))
        .collect();
    let [median, most, nearly_all, all] = quantiles_deg(&costs);
    println!(
        "seeds {FREEZES:?}: 50 % {median:.2}, 95 % {most:.2}, 99 % {nearly_all:.2}, 100 % {all:.2} deg"
    );
    for cost in costs.iter().filter(|cost| cost.extra_deg > most) {
        println!("{cost:?}");
    }
    for (share, bar) in [median, most, all].into_iter().zip(MOST_DEG) {
        assert!(share <= bar, "{share} deg, not {bar}");
    }
}

fn false_trips(seeds: impl IntoParallelIterator<Item = u64>) -> Vec<FalseTrip> {
    let calibration = Calibration::nominal().validate().unwrap();
    seeds
        .into_par_iter()
        .filter_map(|seed| first_fault(seed, &calibration))
        .collect()
}

// REQ-SAFE-10
#[test]
fn a_healthy_angle_trips_nothing() {
    let faults = false_trips(HEALTHY);
    assert!(faults.is_empty(), "seeds {HEALTHY:?}: {faults:?}");
}

// REQ-SAFE-10
#[test]
fn no_fault_of_a_healthy_hitch_that_stands_oscillates_or_lands() {
    let faults = false_trips(
        [
            &SWINGING[..],
            &TAKING_UP,
            &OFF_THE_STOP,
            &LANDING,
            &BOUNCING,
        ]
        .concat(),
    );
    assert!(faults.is_empty(), "{faults:?}");
}

/// A lever that is raised at once while the lowering hitch stands on the ground: the ground is no reason to stay there.
#[test]
fn a_hitch_on_the_ground_follows_a_raised_lever() {
    let calibration = Calibration::nominal().validate().unwrap();
    for seed in [77_000_087, 77_000_274, 77_000_669] {
        let fault = first_fault(seed, &calibration);
        assert!(fault.is_none(), "{fault:?}");
    }
}
