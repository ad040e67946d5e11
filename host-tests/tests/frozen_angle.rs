//! A single angle sensor that freezes at a drawn instant costs a bounded travel, and a healthy one trips nothing.
//!
//! `cargo run --release -p host-tests --bin freeze-the-angle` does it with many more.

use hitch_firmware::control::Calibration;
use host_tests::frozen_angle::freeze::{Case, Cost};
use host_tests::frozen_angle::healthy::{FalseTrip, first_fault};
use host_tests::frozen_angle::quantiles::quantiles_deg;
use rayon::prelude::*;

/// Seeds of the freezes.
const FREEZES: std::ops::RangeInclusive<u64> = 1..=300;
/// Most extra travel of half of them, of 95 % and of all, degree.
const MOST_DEG: [f64; 3] = [3.0, 11.0, 18.0];
/// Seeds of healthy machines, a minute each.
const HEALTHY: std::ops::RangeInclusive<u64> = 1..=20;

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

#[test]
fn a_healthy_angle_trips_nothing() {
    let calibration = Calibration::nominal().validate().unwrap();
    let faults: Vec<FalseTrip> = HEALTHY
        .into_par_iter()
        .filter_map(|seed| first_fault(seed, &calibration))
        .collect();
    assert!(faults.is_empty(), "seeds {HEALTHY:?}: {faults:?}");
}
