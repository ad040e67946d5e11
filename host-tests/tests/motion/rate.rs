//! Rate control: the external button moves the hitch at its set speed for all loads and oil temperatures, in both
//! directions, with and without pressure sensors, after teaching.

use hitch_closed_loop::ClosedLoop;
use hitch_plant::Model;
use hitch_quantities::units::MilliDegreePerSecond;
use hitch_quantities::{Inputs, ValidCalibration};
use host_tests::teaching::{taught_calibration, typical};
use rayon::prelude::*;

const SHIFTS_A: [(f64, f64); 4] = [(0.1, 0.1), (-0.1, -0.1), (0.1, -0.1), (-0.1, 0.1)];
/// Loads to which the limit applies, and others that are only printed.
const LOADS_KG: [f64; 3] = [50.0, 150.0, 250.0];
const OTHER_LOADS_KG: [f64; 2] = [0.0, 500.0];
const TEMPERATURES_C: [f64; 3] = [10.0, 40.0, 70.0];
const RATES_DEG_PER_S: [f64; 8] = [-15.0, -10.0, -5.0, -2.0, 2.0, 5.0, 10.0, 15.0];
/// Largest relative error of the speed.
const BAR: f64 = 0.05;

/// Error of the speed.
#[derive(Clone, Copy, Debug)]
struct Case {
    load_kg: f64,
    oil_temperature_c: f64,
    rate_deg_per_s: f64,
    has_pressures: bool,
}

fn cases(loads_kg: &[f64]) -> Vec<Case> {
    let mut cases = Vec::new();
    for &load_kg in loads_kg {
        for oil_temperature_c in TEMPERATURES_C {
            for rate_deg_per_s in RATES_DEG_PER_S {
                cases.extend([true, false].map(|has_pressures| Case {
                    load_kg,
                    oil_temperature_c,
                    rate_deg_per_s,
                    has_pressures,
                }));
            }
        }
    }
    cases
}

/// Mean speed from the first to the second second of holding the button, over the set speed.
fn speed_ratio(model: &Model, calibration: &ValidCalibration, case: &Case) -> f64 {
    let start_deg = 90.0 - case.rate_deg_per_s;
    let (load_kg, oil_c) = (case.load_kg, case.oil_temperature_c);
    let mut closed_loop = ClosedLoop::new(model, calibration, load_kg, oil_c, start_deg, 9);
    let rate = MilliDegreePerSecond((case.rate_deg_per_s * 1e3).round() as i32);
    let mut after = |ms: usize, jog: Option<MilliDegreePerSecond>| {
        let tell = |inputs: &mut Inputs| {
            inputs.jog = jog;
            if !case.has_pressures {
                inputs.cylinder_pressure = None;
                inputs.pump_pressure = None;
            }
        };
        let samples = (0..ms).map(|_| closed_loop.step_with(60.0, tell, |_, _| {}).angle_deg);
        samples.last().unwrap_or(start_deg)
    };
    // The button is seen released first.
    after(100, None);
    let before_deg = after(1_000, Some(rate));
    (after(1_000, Some(rate)) - before_deg) / case.rate_deg_per_s
}

/// Runs all cases at these loads and prints the worst; returns the number of speeds beyond the limit.
fn beyond_bar(plants: &[(String, Model, ValidCalibration)], loads_kg: &[f64]) -> usize {
    let cases = cases(loads_kg);
    let mut errors: Vec<(f64, &str, &Case)> = plants
        .par_iter()
        .flat_map(|(name, model, calibration)| {
            let cases = cases.par_iter();
            cases.map(move |case| {
                (
                    speed_ratio(model, calibration, case) - 1.0,
                    name.as_str(),
                    case,
                )
            })
        })
        .collect();
    errors.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    for (error, thresholds, case) in errors.iter().take(8) {
        println!("{:+6.1} %  {thresholds}, {case:?}", error * 100.0);
    }
    let beyond = errors.iter().filter(|error| error.0.abs() > BAR).count();
    let bar_percent = BAR * 100.0;
    println!(
        "{loads_kg:?} kg: {beyond} of {} beyond {bar_percent} %",
        errors.len()
    );
    beyond
}

// REQ-MODE-03
#[test]
fn the_button_has_its_speed_whatever_the_load() {
    let plants = SHIFTS_A.map(|(lift_a, lower_a)| {
        let model = typical(lift_a, lower_a);
        let calibration = taught_calibration(&model, 150.0).unwrap();
        (
            format!("thresholds {lift_a:+} {lower_a:+} A"),
            model,
            calibration,
        )
    });
    assert_eq!(beyond_bar(&plants, &LOADS_KG), 0);
    for load_kg in OTHER_LOADS_KG {
        beyond_bar(&plants, &[load_kg]);
    }
}
