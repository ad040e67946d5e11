//! Figure 12: travel time of the hitch over its full travel.
//!
//! The paper shows the figure as a plot without numbers. Its text says that the lifting time does not depend on the
//! load, and that the lowering time decreases with load and with current (section 4.3).

use hitch_effects::find;
use hitch_plant::{AddedEffect, Currents, HitchRig, Model, Plant, Rig, Valve};

use super::flow_lpm;
use super::tables::{
    FIGURE_12_LIFT_A, FIGURE_12_LOADS_KG, FIGURE_12_LOWER_A, table_2, table_5, threshold_a,
};

/// Oil temperature of the tests, degrees Celsius; not stated in the paper.
const OIL_TEMPERATURE_C: f64 = 40.0;
/// Time step of the evaluation, s.
const STEP_S: f64 = 0.01;
/// Distance from the end, m, at which the travel counts as complete: a sensor would not resolve the rest.
const END_WITHIN_M: f64 = 1e-4;
/// Time after which a hitch that has not arrived is given up, s.
const LONGEST_S: f64 = 300.0;

/// Travel times of one panel, s: by current, then by load. Every move has to arrive.
fn panel(model: &Model, valve: Valve, currents_a: [f64; 5]) -> [[f64; 5]; 5] {
    println!("{}, {valve:?}: time, s, by current and load", model.name);
    println!("        {FIGURE_12_LOADS_KG:7.0?} kg");
    currents_a.map(|current_a| {
        let times_s = FIGURE_12_LOADS_KG.map(|load_kg| {
            let time_s = travel_s(model, valve, current_a, load_kg);
            time_s.unwrap_or_else(|| panic!("{current_a} A, {load_kg} kg: never arrives"))
        });
        println!("  {current_a:.1} A {times_s:7.2?}");
        times_s
    })
}

/// Travel time after switching a current on, s; `None` if the end is not reached.
fn travel_s(model: &Model, valve: Valve, current_a: f64, load_kg: f64) -> Option<f64> {
    let stroke_m = model.constants().cylinder.stroke_m;
    let (start_m, [lift_a, lower_a]) = match valve {
        Valve::Lift => (0.0, [current_a, 0.0]),
        Valve::Lower => (stroke_m, [0.0, current_a]),
    };
    let currents = Currents { lift_a, lower_a };
    let rig = Rig::Hitch(HitchRig {
        load_kg,
        start_angle_rad: model.linkage().at(start_m).rocker_angle_rad,
    });
    let mut plant = Plant::new(model, rig, OIL_TEMPERATURE_C, Currents::default());
    let to_go_m =
        |plant: &Plant<'_>| stroke_m - END_WITHIN_M - (plant.state().piston_m - start_m).abs();
    let mut before_m = to_go_m(&plant);
    // The current is switched on within a hundredth of the time step: the plant interprets currents as ramps.
    plant.step(currents, 0.01 * STEP_S);
    for step in 0..(LONGEST_S / STEP_S) as usize {
        let now_m = to_go_m(&plant);
        if now_m <= 0.0 {
            let share = if before_m > now_m {
                before_m / (before_m - now_m)
            } else {
                1.0
            };
            return Some((step as f64 - 1.0 + share) * STEP_S);
        }
        before_m = now_m;
        plant.step(currents, STEP_S);
    }
    None
}

fn fall<const N: usize>(times_s: [f64; N]) -> bool {
    times_s.windows(2).all(|pair| pair[1] < pair[0])
}

fn falls_with_current(times_s: &[[f64; 5]; 5]) -> bool {
    (0..5).all(|load| fall(times_s.map(|row| row[load])))
}

// REQ-DIAG-11
#[test]
fn lifting_time_does_not_depend_on_load() {
    for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        let times_s = panel(&model, Valve::Lift, FIGURE_12_LIFT_A);
        let spreads = times_s.map(|row| {
            let least = row.into_iter().fold(f64::INFINITY, f64::min);
            let greatest = row.into_iter().fold(0.0, f64::max);
            (greatest - least) * 5.0 / row.iter().sum::<f64>()
        });
        let spread = spreads.into_iter().fold(0.0, f64::max);
        println!("  spread over load: {:.3} %", 100.0 * spread);
        assert!(spread < 0.01, "{}: {spread}", model.name);
        assert!(falls_with_current(&times_s), "{}", model.name);
    }
}

// REQ-DIAG-11
#[test]
fn lowering_time_falls_with_load_and_with_current() {
    for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        let times_s = panel(&model, Valve::Lower, FIGURE_12_LOWER_A);
        assert!(times_s.into_iter().all(fall), "{}", model.name);
        assert!(falls_with_current(&times_s), "{}", model.name);
    }
}

/// At the lowest current the time depends strongly on the threshold; the figure's axis ends at 30 s.
#[test]
fn the_slowest_lift_is_faster_with_the_threshold_of_table_5() {
    let model = hitch_model_file::nominal();
    let shift_a = table_5(Valve::Lift).threshold_a - threshold_a(table_2(Valve::Lift));
    let effect = find("lift-threshold-shift").unwrap();
    let values = vec![shift_a];
    let shifted = model.with_effects(vec![AddedEffect { effect, values }]);
    let [with_table_2_s, with_table_5_s] = [&model, &shifted].map(|model| {
        travel_s(
            model,
            Valve::Lift,
            FIGURE_12_LIFT_A[0],
            FIGURE_12_LOADS_KG[0],
        )
        .unwrap()
    });
    println!(
        "slowest lift: {with_table_2_s:.1} s with Table 2, {with_table_5_s:.1} s with Table 5"
    );
    assert!(with_table_5_s < with_table_2_s);
}

#[test]
fn lifting_takes_the_volume_over_the_flow() {
    let model = hitch_model_file::nominal();
    let volume_l = 0.25 * std::f64::consts::PI * 0.76 * 0.76 * 1.579;
    let expected_s = volume_l / flow_lpm(&model, Valve::Lift, 1.8) * 60.0;
    let time_s = travel_s(&model, Valve::Lift, 1.8, 150.0).unwrap();
    assert!(
        (time_s / expected_s - 1.0).abs() < 2e-3,
        "{time_s} s against {expected_s} s"
    );
}

#[test]
fn a_current_below_the_threshold_never_arrives() {
    let model = hitch_model_file::nominal();
    assert_eq!(travel_s(&model, Valve::Lift, 1.0, 150.0), None);
}
