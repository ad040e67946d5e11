//! The load-sensing pump and the measured linkage against physics.

use hitch_plant::units::{bar_from_pa, pa_from_bar};
use hitch_plant::{Currents, HitchRig, LinkageError, LinkageTable, Model, Plant, PumpKind, Rig};

const STANDBY_BAR: f64 = 22.0;

fn load_sensing(model: &Model, response_s: f64) -> Model {
    let mut constants = model.constants().clone();
    constants.pump.kind = PumpKind::LoadSensing;
    constants.pump.standby_pressure_pa = pa_from_bar(STANDBY_BAR);
    constants.pump.response_time_s = response_s;
    model.with_constants(constants).unwrap()
}

fn lift(current_a: f64) -> Currents {
    Currents {
        lift_a: current_a,
        lower_a: 0.0,
    }
}

fn bench(port_bar: f64) -> Rig {
    Rig::Flow {
        port_pressure_pa: pa_from_bar(port_bar),
    }
}

/// Both pumps keep the same margin and deliver at most the same flow, so a valve passes the same flow; only the pressure
/// without a request differs.
#[test]
fn a_load_sensing_pump_differs_from_a_bypass_only_in_its_standby_pressure() {
    let fixed = hitch_model_file::nominal();
    let sensing = load_sensing(&fixed, 0.0);
    for port_bar in [20.0, 120.0, 153.0] {
        for current_a in [0.0, 1.5, 2.4, 3.4] {
            let flows = [&fixed, &sensing]
                .map(|model| Plant::new(model, bench(port_bar), 40.0, lift(current_a)).flows());
            let [bypassed, sensed] = flows;
            assert_eq!(bypassed.lift_m3_s, sensed.lift_m3_s);
            let idle_bar = bar_from_pa(sensed.pump_pressure_pa);
            if current_a > 1.2 {
                assert_eq!(bypassed.pump_pressure_pa, sensed.pump_pressure_pa)
            } else {
                assert!((idle_bar - STANDBY_BAR).abs() < 1e-9, "{idle_bar}")
            }
        }
    }
}

/// A step of the current with a time constant of 100 ms: the pump pressure covers 63 % of its way in this time.
#[test]
fn the_pump_pressure_rises_with_its_time_constant() {
    let model = load_sensing(&hitch_model_file::dynamic(), 0.1);
    let mut constants = model.constants().clone();
    constants.spool_time_constant_s = 0.0;
    let model = model.with_constants(constants).unwrap();
    let rig = Rig::Hitch(HitchRig {
        load_kg: 250.0,
        start_angle_rad: 1.6,
    });
    // A current at which the hitch hardly moves.
    let mut plant = Plant::new(&model, rig, 40.0, Currents::default());
    let load_bar = bar_from_pa(plant.state().pressure_pa);
    let target_bar = load_bar + 4.0;
    plant.step(lift(1.14), 1e-6);
    for _ in 0..100 {
        plant.step(lift(1.14), 1e-3);
    }
    let covered =
        (bar_from_pa(plant.flows().pump_pressure_pa) - STANDBY_BAR) / (target_bar - STANDBY_BAR);
    assert!((covered - 0.632).abs() < 0.02, "{covered}");
    for _ in 0..900 {
        plant.step(lift(1.14), 1e-3);
    }
    let reached_bar = bar_from_pa(plant.flows().pump_pressure_pa - plant.state().pressure_pa);
    assert!((reached_bar - 4.0).abs() < 0.05, "{reached_bar}");
}

/// A plant at rest with an open valve has the pump pressure of this opening, whatever the lag of the pump.
#[test]
fn a_flow_bench_at_rest_is_settled() {
    let dynamic = hitch_model_file::dynamic();
    let flows = [0.0, 0.1].map(|response_s| {
        let model = load_sensing(&dynamic, response_s);
        Plant::new(&model, bench(60.0), 40.0, lift(2.0)).flows()
    });
    assert!(flows[0].lift_m3_s > 2e-4);
    assert_eq!(flows[0], flows[1]);
}

fn measured(model: &Model, points: u32) -> LinkageTable {
    let stroke_m = model.constants().cylinder.stroke_m;
    let travel_m = (0..=points).map(|k| stroke_m * f64::from(k) / f64::from(points));
    let travel_m: Vec<f64> = travel_m.collect();
    let postures = travel_m.iter().map(|&at_m| model.linkage().at(at_m));
    let (angles, heights) = postures
        .map(|posture| (posture.rocker_angle_rad, posture.height_m))
        .unzip();
    LinkageTable::new(travel_m, angles, heights).unwrap()
}

#[test]
fn a_measured_linkage_is_that_of_the_dimensions() {
    let model = hitch_model_file::nominal();
    let mut constants = model.constants().clone();
    constants.linkage_table = Some(measured(&model, 20));
    let tabulated = model.with_constants(constants).unwrap();
    for mm in 8..150 {
        let [a, b] = [&model, &tabulated].map(|model| model.linkage().at(f64::from(mm) * 1e-3));
        assert!(
            (a.rocker_angle_rad - b.rocker_angle_rad).abs() < 1e-3,
            "{mm} mm"
        );
        assert!((a.height_m - b.height_m).abs() < 2e-4, "{mm} mm");
        assert!(
            (b.dh_dx / a.dh_dx - 1.0).abs() < 0.01,
            "{mm} mm: {} {}",
            a.dh_dx,
            b.dh_dx
        );
        let back_m = tabulated.linkage().piston_m(b.rocker_angle_rad);
        assert!((back_m - f64::from(mm) * 1e-3).abs() < 1e-6);
    }
}

#[test]
fn a_measured_linkage_has_to_cover_the_stroke() {
    let model = hitch_model_file::nominal();
    let mut constants = model.constants().clone();
    constants.linkage_table = Some(measured(&model, 20));
    constants.cylinder.stroke_m += 0.01;
    let fault = model.with_constants(constants).unwrap_err();
    assert!(matches!(fault, LinkageError::Table { .. }), "{fault}");
}

/// Two cylinders move at half the speed of one with the same oil, and hold the load at half its pressure.
#[test]
fn two_cylinders_have_twice_the_area() {
    let one = hitch_model_file::nominal();
    let mut constants = one.constants().clone();
    constants.cylinder.count = 2;
    let two = one.with_constants(constants).unwrap();
    let rig = Rig::Hitch(HitchRig {
        load_kg: 150.0,
        start_angle_rad: 1.5,
    });
    let states = [&one, &two].map(|model| Plant::new(model, rig, 40.0, lift(1.6)).state());
    assert!((states[0].pressure_pa / states[1].pressure_pa - 2.0).abs() < 1e-9);
    assert!((states[0].speed_m_s / states[1].speed_m_s - 2.0).abs() < 1e-9);
}
