//! Tests of the plant against physics: kinematics, balances, limits.

use hitch_effects::find;
use hitch_plant::units::{bar_from_pa, lpm_from_m3_s, pa_from_bar};
use hitch_plant::{AddedEffect, Currents, HitchRig, Plant, Rig};
use proptest::prelude::*;

const STEP_S: f64 = 0.002;

fn hitch(load_kg: f64, start_angle_deg: f64) -> Rig {
    Rig::Hitch(HitchRig {
        load_kg,
        start_angle_rad: start_angle_deg.to_radians(),
    })
}

fn currents(lift_a: f64, lower_a: f64) -> Currents {
    Currents { lift_a, lower_a }
}

/// A lift, a hold, a lowering and a hold, with ramps.
fn manoeuvre(lift_a: f64, lower_a: f64) -> impl Iterator<Item = Currents> {
    let trapezoid = move |time_s: f64, start_s: f64| -> f64 {
        let (rise, fall) = ((time_s - start_s) / 0.15, (start_s + 1.0 - time_s) / 0.15);
        rise.min(fall).clamp(0.0, 1.0)
    };
    (0..2000).map(move |step| {
        let time_s = f64::from(step) * STEP_S;
        currents(
            lift_a * trapezoid(time_s, 0.1),
            lower_a * trapezoid(time_s, 2.0),
        )
    })
}

/// docs/plant.md: piston travel mm, rocker angle deg, height m, dh/dx, d2h/dx2 1/m.
const KINEMATICS: [[f64; 5]; 5] = [
    [0.0, 44.10, -0.8556, 4.592, -29.1],
    [39.5, 69.31, -0.6844, 4.235, -0.70],
    [79.0, 90.14, -0.5164, 4.296, 2.68],
    [118.5, 111.41, -0.3449, 4.365, -0.52],
    [158.0, 135.90, -0.1759, 4.092, -16.3],
];

#[test]
fn the_joints_keep_the_dimensions_and_carry_the_hitch_point() {
    let model = hitch_model_file::nominal();
    let dimensions = &model.constants().linkage;
    for [_, angle_deg, ..] in KINEMATICS {
        let joints = dimensions.joints(angle_deg.to_radians()).unwrap();
        let lengths = [
            (
                joints.rocker_end - joints.piston_pin,
                dimensions.connecting_rod_m,
            ),
            (joints.rocker_end.coords, dimensions.rocker_arm_m),
            (joints.lift_arm_end.coords, dimensions.lift_arm_m),
            (
                joints.rod_joint - joints.lift_arm_end,
                dimensions.lift_rod_m,
            ),
            (joints.rod_joint - joints.pivot, dimensions.lift_rod_joint_m),
            (joints.hitch_point - joints.pivot, dimensions.lower_link_m),
        ];
        for (bar, length_m) in lengths {
            assert!((bar.norm() - length_m).abs() < 1e-12);
        }
        let piston_m = model.linkage().piston_m(angle_deg.to_radians());
        let height_m = model.linkage().at(piston_m).height_m;
        assert!((joints.hitch_point.y - height_m).abs() < 1e-4);
    }
}

#[test]
fn another_load_during_a_run_comes_to_the_rest_of_a_run_with_it() {
    for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        let mut plant = Plant::new(&model, hitch(50.0, 90.0), 40.0, Currents::default());
        plant.set_load_kg(250.0);
        (0..2000).for_each(|_| plant.step(Currents::default(), STEP_S));
        let changed = plant.reading();
        let own = Plant::new(
            &model,
            hitch(250.0, changed.rocker_angle_deg),
            40.0,
            Currents::default(),
        );
        let own_bar = own.reading().cylinder_pressure_bar;
        assert!((changed.cylinder_pressure_bar - own_bar).abs() < 0.05);
        // The oil is compressed by 18 bar.
        let sunk_deg = 90.0 - changed.rocker_angle_deg;
        assert!((-0.01..0.6).contains(&sunk_deg), "{sunk_deg}");
    }
}

#[test]
fn another_oil_temperature_during_a_run_flows_as_in_a_run_with_it() {
    let viscosity = AddedEffect::typical(find("oil-viscosity").unwrap());
    let model = hitch_model_file::dynamic().with_effects(vec![viscosity]);
    let lowered_deg = |plant: &mut Plant<'_>| {
        (0..500).for_each(|_| plant.step(currents(0.0, 2.0), STEP_S));
        plant.reading().rocker_angle_deg
    };
    let plant = |oil_c: f64| Plant::new(&model, hitch(150.0, 110.0), oil_c, Currents::default());
    let (mut cold, mut warm, mut cooled) = (plant(10.0), plant(60.0), plant(60.0));
    cooled.set_oil_temperature_c(10.0);
    let (cold, warm, cooled) = (
        lowered_deg(&mut cold),
        lowered_deg(&mut warm),
        lowered_deg(&mut cooled),
    );
    assert!((cold - cooled).abs() < 1e-6, "{cold} {cooled}");
    assert!((cold - warm).abs() > 0.5, "{cold} {warm}");
}

#[test]
fn the_linkage_moves_as_the_rig_is_dimensioned() {
    let model = hitch_model_file::nominal();
    for [piston_mm, angle_deg, height_m, dh_dx, d2h_dx2] in KINEMATICS {
        let posture = model.linkage().at(piston_mm / 1000.0);
        assert!((posture.rocker_angle_rad.to_degrees() - angle_deg).abs() < 0.05);
        assert!((posture.height_m / height_m - 1.0).abs() < 1e-3);
        assert!((posture.dh_dx / dh_dx - 1.0).abs() < 1e-3);
        // The table has three digits of a second derivative that passes through zero.
        assert!((posture.d2h_dx2_1_m - d2h_dx2).abs() < 0.05 + 1e-3 * d2h_dx2.abs());
        let back_m = model.linkage().piston_m(posture.rocker_angle_rad);
        assert!((back_m - piston_mm / 1000.0).abs() < 1e-7);
    }
}

#[test]
fn the_transmission_is_the_slope_of_the_height() {
    let model = hitch_model_file::nominal();
    for step in 1..158 {
        let (piston_m, half_m) = (f64::from(step) / 1000.0, 5e-4);
        let rise_m = model.linkage().at(piston_m + half_m).height_m
            - model.linkage().at(piston_m - half_m).height_m;
        let slope = rise_m / (2.0 * half_m);
        assert!((slope / model.linkage().at(piston_m).dh_dx - 1.0).abs() < 1e-4);
    }
}

/// A hitch at rest that its sensor shows below the ground stands without pressure, and the pump lifts it without load
/// until the ground no longer carries it: the quasi-static plant from the shown position, in a hollow, the dynamic
/// plant from the ground.
#[test]
fn a_hitch_that_is_seen_below_the_ground_is_not_thrown_out() {
    for (model, on_it) in [
        (hitch_model_file::nominal(), false),
        (hitch_model_file::dynamic(), true),
    ] {
        let ground = AddedEffect {
            effect: find("ground-contact").unwrap(),
            values: vec![0.25, 1000.0],
        };
        let model = model.with_effects(vec![ground]);
        let mut plant = Plant::new(&model, hitch(250.0, 55.0), 40.0, Currents::default());
        let angle_deg = |plant: &Plant| plant.rocker_angle_rad().to_degrees();
        for _ in 0..500 {
            plant.step(Currents::default(), STEP_S);
        }
        // The ground, which carries 250 kg and 30 kg of links, deflects by 280 kg * 9.81 m/s2 / 1 MN/m.
        let height_m = |piston_m| model.linkage().at(piston_m).height_m;
        let over_the_lowest_m = height_m(plant.state().piston_m) - height_m(0.0);
        if on_it {
            let yielded_m = 0.25 - over_the_lowest_m;
            assert!((yielded_m - 2.75e-3).abs() < 1e-4, "{yielded_m} m");
        } else {
            assert!((angle_deg(&plant) - 55.0).abs() < 0.1);
        }
        assert!(plant.reading().cylinder_pressure_bar < 0.5);
        let mut carried_bar: f64 = 0.0;
        while angle_deg(&plant) < 90.0 {
            if (65.0..70.0).contains(&angle_deg(&plant)) {
                carried_bar = carried_bar.max(plant.reading().cylinder_pressure_bar);
            }
            plant.step(currents(1.6, 0.0), STEP_S);
        }
        assert!(carried_bar < 5.0, "{}: {carried_bar} bar", model.name);
        let lifted_bar = plant.reading().cylinder_pressure_bar;
        assert!(lifted_bar > 20.0, "{}: {lifted_bar} bar", model.name);
    }
}

/// A stop exerts a force only during the contact; afterwards only the weight is held, with steps of any length.
#[test]
fn what_stopped_the_masses_does_not_stay_in_the_cylinder() {
    let inertia = AddedEffect::typical(find("load-inertia").unwrap());
    let model = hitch_model_file::nominal().with_effects(vec![inertia]);
    for step_s in [0.002, 0.004, 0.02] {
        let mut plant = Plant::new(&model, hitch(250.0, 90.0), 40.0, Currents::default());
        let mut largest_bar: f64 = 0.0;
        let steps = (3.0 / step_s) as u32;
        for step in 0..steps {
            let time_s = f64::from(step) * step_s;
            let lift_a = 2.0 * (time_s / 0.1).min((1.0 - time_s) / 0.1).clamp(0.0, 1.0);
            plant.step(currents(lift_a, 0.0), step_s);
            largest_bar = largest_bar.max(plant.reading().cylinder_pressure_bar);
        }
        let held_deg = plant.rocker_angle_rad().to_degrees();
        let alone = Plant::new(&model, hitch(250.0, held_deg), 40.0, Currents::default());
        let weight_bar = alone.reading().cylinder_pressure_bar;
        let held_bar = plant.reading().cylinder_pressure_bar;
        assert!(largest_bar > 1.05 * weight_bar, "nothing was accelerated");
        assert!(
            (held_bar - weight_bar).abs() < 1e-3,
            "{step_s} s: {held_bar} bar held, {weight_bar} bar of weight"
        );
    }
}

#[test]
fn the_cylinder_holds_what_hangs_on_the_hitch() {
    // docs/plant.md: with 30 kg dead weight about 7.4 bar at 50 kg and 26 bar at 250 kg.
    let model = hitch_model_file::nominal();
    for (load_kg, bar) in [(50.0, 7.4), (250.0, 26.0)] {
        let plant = Plant::new(&model, hitch(load_kg, 90.0), 40.0, Currents::default());
        assert!((plant.reading().cylinder_pressure_bar - bar).abs() < 0.02 * bar);
    }
}

#[test]
fn a_flow_bench_gives_back_table_2() {
    for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
        for (lift_a, lower_a, port_bar, flow_lpm) in [
            (1.568, 0.0, 20.0, 8.128),
            (3.3, 0.0, 120.0, 39.929),
            (0.0, 1.502, 15.0, -2.674),
            (0.0, 3.3, 15.0, -58.717),
            (0.0, 3.3, 3.75, -58.717 / 2.0),
        ] {
            let rig = Rig::Flow {
                port_pressure_pa: pa_from_bar(port_bar),
            };
            let plant = Plant::new(&model, rig, 40.0, currents(lift_a, lower_a));
            let error = (plant.reading().flow_lpm - flow_lpm).abs();
            assert!(
                error < 1e-3 * flow_lpm.abs(),
                "{flow_lpm} l/min is off by {error}"
            );
        }
    }
}

#[test]
fn near_relief_the_lift_flow_goes_with_the_root_of_the_drop_that_is_left() {
    // 154 bar less 2.5 bar of the check valve less 151.125 bar at the port leaves a quarter of 1.5 bar: half the flow.
    let model = hitch_model_file::nominal();
    let rig = Rig::Flow {
        port_pressure_pa: pa_from_bar(151.125),
    };
    let plant = Plant::new(&model, rig, 40.0, currents(3.3, 0.0));
    assert!((plant.reading().flow_lpm - 39.929 / 2.0).abs() < 1e-6);
    assert!((plant.reading().pump_pressure_bar - 154.0).abs() < 1e-9);
}

#[test]
fn a_valve_wider_than_the_pump_passes_the_pump_flow_below_the_margin() {
    let scale = AddedEffect {
        effect: find("lift-flow-scale").expect("in the catalogue"),
        values: vec![0.5],
    };
    let model = hitch_model_file::nominal().with_effects(vec![scale]);
    let rig = Rig::Flow {
        port_pressure_pa: pa_from_bar(50.0),
    };
    let reading = Plant::new(&model, rig, 40.0, currents(3.3, 0.0)).reading();
    assert!((reading.flow_lpm - 54.5 * 0.88).abs() < 1e-9);
    // Closed form: dp = 1.5 bar (Q_pump / Q_valve)^2, on top of port and check valve.
    let drop_bar = 1.5 * (54.5 * 0.88 / (1.5 * 39.929_f64)).powi(2);
    assert!((reading.pump_pressure_bar - (50.0 + 2.5 + drop_bar)).abs() < 1e-9);
}

#[test]
fn at_the_upper_stop_the_pump_dead_heads_at_relief_and_no_further() {
    let model = hitch_model_file::dynamic();
    let mut plant = Plant::new(&model, hitch(150.0, 130.0), 40.0, Currents::default());
    for step in 0..1000 {
        plant.step(currents((0.01 * f64::from(step)).min(2.5), 0.0), STEP_S);
    }
    let reading = plant.reading();
    assert!((reading.pump_pressure_bar - 154.0).abs() < 0.1);
    // There is no lift flow if the port pressure is the relief pressure less the cracking pressure, 154 - 2.5 bar.
    assert!((reading.cylinder_pressure_bar - 151.5).abs() < 0.05);
    assert!(reading.flow_lpm.abs() < 0.05);
    let stroke_m = model.constants().cylinder.stroke_m;
    assert!((plant.state().piston_m - stroke_m).abs() < 1e-9);
}

/// Balance of the energy supplied by the oil and that of load, friction and motion: `int p Q dt = dE_pot + dE_kin +
/// dE_oil + int b v2 dt`, including the oil's share `p2 V / 2E`.
#[test]
fn the_oils_work_is_found_again_in_the_hitch() {
    let model = hitch_model_file::dynamic();
    let constants = model.constants();
    let load_kg = 150.0;
    let mut plant = Plant::new(&model, hitch(load_kg, 70.0), 40.0, Currents::default());
    let stored = |plant: &Plant| {
        let state = plant.state();
        let posture = model.linkage().at(state.piston_m);
        let mass_kg = load_kg + constants.masses.dead_weight_kg;
        let inertia_kg = constants.masses.inertia_kg(load_kg, posture.dh_dx);
        let oil_j = state.pressure_pa.powi(2) * constants.cylinder.volume_m3(state.piston_m)
            / (2.0 * constants.oil.bulk_modulus_pa);
        mass_kg * 9.81 * posture.height_m + 0.5 * inertia_kg * state.speed_m_s.powi(2) + oil_j
    };
    let start_j = stored(&plant);
    let (mut brought_j, mut lost_j) = (0.0, 0.0);
    let mut power = (0.0, 0.0);
    for current in manoeuvre(2.0, 1.9) {
        plant.step(current, STEP_S);
        let state = plant.state();
        let now = (
            state.pressure_pa * plant.flows().net_m3_s(),
            constants.cylinder.viscous_friction_n_s_m * state.speed_m_s.powi(2),
        );
        brought_j += 0.5 * (power.0 + now.0) * STEP_S;
        lost_j += 0.5 * (power.1 + now.1) * STEP_S;
        power = now;
    }
    let gained_j = stored(&plant) - start_j;
    let turnover_j = lost_j + 500.0;
    let missing_j = brought_j - lost_j - gained_j;
    // Of the order of p/E, which the constant bulk modulus neglects, and of the error of the trapezoidal rule.
    assert!(
        missing_j.abs() < 0.01 * turnover_j,
        "{missing_j} J of {turnover_j} J are missing"
    );
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, rng_seed: proptest::test_runner::RngSeed::Fixed(2026), ..Default::default() })]

    /// The net volume through the valves, less leakage, is under the piston, for every load, current and effect size.
    #[test]
    fn volume_is_kept(
        load_kg in 0.0..300.0_f64,
        lift_a in 0.0..2.2_f64,
        lower_a in 0.0..2.2_f64,
        leak in 0.0..0.01_f64,
        force_n in 0.0..900.0_f64,
        dynamic in any::<bool>(),
    ) {
        let added = |id: &str, value: f64| AddedEffect {
            effect: find(id).expect("in the catalogue"),
            values: vec![value],
        };
        let start = if dynamic { hitch_model_file::dynamic() } else { hitch_model_file::nominal() };
        let model = start.with_effects(vec![
            added("lowering-leakage", leak),
            added("coulomb-friction", force_n),
        ]);
        let cylinder = &model.constants().cylinder;
        let mut plant = Plant::new(&model, hitch(load_kg, 80.0), 40.0, Currents::default());
        let compressed = |plant: &Plant| {
            let state = plant.state();
            let stiffness = if dynamic { model.constants().oil.bulk_modulus_pa } else { f64::INFINITY };
            cylinder.volume_m3(state.piston_m) * (1.0 + state.pressure_pa / stiffness)
        };
        let (start_m3, start_m) = (compressed(&plant), plant.state().piston_m);
        let (mut through_m3, mut before) = (0.0, plant.flows().net_m3_s());
        for current in manoeuvre(lift_a, lower_a) {
            plant.step(current, STEP_S);
            let state = plant.state();
            prop_assume!(state.piston_m > 0.001 && state.piston_m < cylinder.stroke_m - 0.001);
            prop_assume!(state.pressure_pa > 0.0);
            let now = plant.flows().net_m3_s();
            through_m3 += 0.5 * (before + now) * STEP_S;
            before = now;
        }
        let gained_m3 = compressed(&plant) - start_m3;
        let moved_m3 = (plant.state().piston_m - start_m).abs() * cylinder.area_m2();
        prop_assert!((gained_m3 - through_m3).abs() < 2e-7 + 2e-3 * moved_m3,
            "{} cm3 gained, {} cm3 through the valves", gained_m3 * 1e6, through_m3 * 1e6);
    }

    /// No reverse flow through the check valve, and a pump pressure between idle and relief, with any currents.
    #[test]
    fn valves_and_pressures_stay_within_their_limits(
        load_kg in 0.0..300.0_f64,
        angle_deg in 44.0..136.0_f64,
        dynamic in any::<bool>(),
        levels in prop::collection::vec((0.0..3.5_f64, 0.0..3.5_f64), 1..12),
    ) {
        let model = if dynamic { hitch_model_file::dynamic() } else { hitch_model_file::nominal() };
        let mut plant = Plant::new(&model, hitch(load_kg, angle_deg), 40.0, Currents::default());
        for (lift_a, lower_a) in levels {
            for _ in 0..100 {
                plant.step(currents(lift_a, lower_a), STEP_S);
                let (flows, state) = (plant.flows(), plant.state());
                prop_assert!(flows.lift_m3_s >= 0.0 && flows.lower_m3_s >= 0.0);
                prop_assert!(flows.lift_m3_s <= model.constants().pump.flow_m3_s() * (1.0 + 1e-12));
                let pump_bar = bar_from_pa(flows.pump_pressure_pa);
                prop_assert!((0.0..=154.0 + 1e-9).contains(&pump_bar), "{pump_bar} bar at the pump");
                prop_assert!(state.piston_m.is_finite() && state.speed_m_s.is_finite());
                prop_assert!(bar_from_pa(state.pressure_pa) >= -1.0 - 1e-9);
                if flows.lift_m3_s > 0.0 {
                    let drop_pa = flows.pump_pressure_pa - state.pressure_pa;
                    prop_assert!(drop_pa >= model.constants().check_valve.cracking_pressure_pa);
                }
            }
        }
    }

    /// A held hitch is at rest: both coils off, no leakage, no motion and no flow.
    #[test]
    fn a_held_hitch_stands(load_kg in 0.0..300.0_f64, angle_deg in 46.0..134.0_f64) {
        for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()] {
            let mut plant = Plant::new(&model, hitch(load_kg, angle_deg), 40.0, Currents::default());
            for _ in 0..500 {
                plant.step(Currents::default(), 0.02);
            }
            prop_assert!((plant.reading().rocker_angle_deg - angle_deg).abs() < 0.01);
            prop_assert!(lpm_from_m3_s(plant.flows().net_m3_s()).abs() < 1e-9);
        }
    }
}
