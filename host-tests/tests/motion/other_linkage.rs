//! A machine with another linkage: the hitch of category III, from its data sheets to motion.
//!
//! Its equations of motion share no code with the model, from which its calibration follows.

use hitch_closed_loop::calibrate::calibrate;
use hitch_controller::Controller;
use hitch_quantities::units::{MilliBar, MilliDegree, MilliVolt};
use hitch_quantities::{Calibration, Fault, Inputs, ValidCalibration};
use host_tests::program::run;
use truth_rigs::category_three::files::write;
use truth_rigs::category_three::machine::{BAR, STROKE_M, Wear, angle_deg};
use truth_rigs::category_three::motion::{Motion, STEP_S};

/// Loads, kg.
const LOADS_KG: [f64; 2] = [400.0, 2000.0];
/// Places of the lever in turn, degree.
const ANGLES_DEG: [f64; 9] = [60.0, 90.0, 65.0, 75.0, 72.0, 105.0, 101.0, 50.0, 54.0];
/// Time for each, ms.
const MOVE_MS: usize = 4_000;
/// Limits of the overshoot and of the final error, degree. The machine is not identified; one of its 16 moves misses the 0.3
/// degree that an identified one keeps.
const OVERSHOOT_DEG: f64 = 0.4;
const FINAL_DEG: f64 = 0.5;

/// The command of docs/your-own-hitch.md that makes a model of the data sheets.
const SHEET: &str = "model new --from dynamic --pump load-sensing --lift-curve machine/lift_valve.csv \
    --lower-curve machine/lowering_valve.csv --linkage-table machine/linkage.csv --set \
    cylinder.cylinders=2 --set cylinder.bore_mm=90 --set cylinder.dead_volume_l=0.6 --set \
    cylinder.viscous_friction_n_s_m=25000 --set pump.theoretical_flow_lpm=99 --set \
    pump.volumetric_efficiency=0.93 --set pump.standby_pressure_bar=22 --set \
    pump.response_time_ms=50 --set compensator.margin_bar=20 --set \
    check_valve.cracking_pressure_bar=3 --set relief_valve.set_pressure_bar=200 --set \
    lift_valve.reference_drop_bar=17 --set lower_valve.reference_drop_bar=50 --set \
    solenoid.resistance_ohm=5 --set solenoid.inductance_mh=20 --set loads.light_kg=400 --set \
    loads.usual_kg=1200 --set loads.heavy_kg=2000 --set spool.time_constant_ms=30 --set \
    masses.dead_weight_kg=180 --set masses.piston_kg=40 --yes --out sheet.toml";

/// Share of the stroke at a rocker angle, degree.
fn share_at(deg: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if angle_deg(middle) < deg {
            low = middle
        } else {
            high = middle
        }
    }
    low
}

/// The calibration from the data sheets.
fn from_data_sheets() -> Calibration {
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("machine")).unwrap();
    let words: Vec<&str> = SHEET.split_whitespace().collect();
    let output = run(folder.path(), &words);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let model = hitch_model_file::read(&folder.path().join("sheet.toml")).unwrap();
    (*calibrate(&model, &Calibration::nominal()).unwrap()).clone()
}

/// Overshoot and final error of each move, degree, and the first fault.
fn moves(calibration: &ValidCalibration, load_kg: f64) -> (Vec<[f64; 2]>, Option<Fault>) {
    let travel_m = STROKE_M * share_at(ANGLES_DEG[0]);
    let mut motion = Motion::at_rest(load_kg, Wear::New, travel_m);
    let mut controller = Controller::new(calibration.clone());
    let mut fault = None;
    let mut step = |lever_deg: f64| {
        let milli = |value: f64| (value * 1e3).round() as i32;
        let rocker_deg = angle_deg(motion.travel_m() / STROKE_M);
        let [cylinder, pump] = motion
            .pressures_pa()
            .map(|pressure_pa| MilliBar(milli(pressure_pa / BAR)));
        let outputs = controller.step(&Inputs {
            lever: Some(MilliDegree(milli(lever_deg))),
            rocker_angle: Some(MilliDegree(milli(rocker_deg))),
            cylinder_pressure: Some(cylinder),
            pump_pressure: Some(pump),
            supply: Some(MilliVolt(13_800)),
            ..Inputs::default()
        });
        fault = fault.or(outputs.fault);
        let currents_a = [outputs.lift_current, outputs.lower_current]
            .map(|current| 1e-3 * f64::from(current.0));
        for _ in 0..(1e-3 / STEP_S) as usize {
            motion.step(currents_a);
        }
        rocker_deg
    };
    for (away_deg, steps) in [(-3.0, 300), (0.0, 500)] {
        for _ in 0..steps {
            step(ANGLES_DEG[0] + away_deg);
        }
    }
    let mut figures = Vec::new();
    for pair in ANGLES_DEG.windows(2) {
        let way = (pair[1] - pair[0]).signum();
        let beyond: Vec<f64> = (0..MOVE_MS)
            .map(|_| (step(pair[1]) - pair[1]) * way)
            .collect();
        let most = beyond.iter().copied().fold(0.0, f64::max);
        figures.push([most, beyond[MOVE_MS - 1].abs()]);
    }
    (figures, fault)
}

// REQ-MOTION-01
#[test]
fn a_machine_with_another_linkage_moves_well_from_its_data_sheets() {
    let calibration = from_data_sheets();
    println!(
        "ratio {:?}, stop band {:?}, restart band {:?}",
        calibration.hydraulics.load_ratio,
        calibration.position.stop_band,
        calibration.position.restart_band
    );
    // Closed forms: 0.8 m of height and 95 degrees over the stroke.
    let nominal = Calibration::nominal();
    let ratio = 1e-3 * f64::from(calibration.hydraulics.load_ratio.0);
    assert!((ratio * STROKE_M / 0.8 - 1.0).abs() < 0.01, "{ratio}");
    let [first, .., last] = nominal.linkage.travel;
    let rig_mm_deg = 1e-3 * f64::from((last - first).0) / 92.0;
    let longer = 1e3 * STROKE_M / 95.0 / rig_mm_deg;
    let restart_um = f64::from(nominal.position.restart_band.0);
    let found_um = f64::from(calibration.position.restart_band.0);
    assert!((found_um / (longer * restart_um) - 1.0).abs() < 0.02);
    let mut of_the_rig = calibration.clone();
    of_the_rig.hydraulics.load_ratio = nominal.hydraulics.load_ratio;
    of_the_rig.position.stop_band = nominal.position.stop_band;
    of_the_rig.position.restart_band = nominal.position.restart_band;
    for (name, calibration, judged) in [
        ("bands and ratio of the rig", of_the_rig, false),
        ("its own", calibration, true),
    ] {
        let calibration = calibration.sealed().validate().unwrap();
        for load_kg in LOADS_KG {
            let (figures, fault) = moves(&calibration, load_kg);
            println!("{name}, {load_kg} kg: {figures:.2?}, {fault:?}");
            let well = figures
                .iter()
                .all(|&[over, last]| over <= OVERSHOOT_DEG && last <= FINAL_DEG);
            assert!(!judged || (well && fault.is_none()), "{name}, {load_kg} kg");
        }
    }
}
