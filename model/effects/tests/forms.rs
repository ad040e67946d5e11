//! Effects with more than one form, against closed forms on the flow bench.

use hitch_effects::CATALOGUE;
use hitch_plant::simulation::simulate;
use hitch_plant::units::pa_from_bar;
use hitch_plant::{AddedEffect, Channel, Currents, Effect, HitchRig, Model, Plant, Rig, full_name};

fn effect(name: &str) -> &'static dyn Effect {
    let mut catalogue = CATALOGUE.iter().copied();
    catalogue
        .find(|effect| full_name(*effect) == name)
        .expect("an effect of the catalogue")
}

/// The nominal model with one effect.
fn model(name: &str, values: &[f64]) -> Model {
    hitch_model_file::nominal().with_effects(vec![AddedEffect {
        effect: effect(name),
        values: values.to_vec(),
    }])
}

/// Flow, l/min, of the flow meter on the bench with a lift and a lowering current over time.
fn flow_lpm(
    model: &Model,
    port_bar: f64,
    oil_temperature_c: f64,
    time_s: &[f64],
    currents: impl Fn(f64) -> Currents,
) -> Vec<f64> {
    let rig = Rig::Flow {
        port_pressure_pa: pa_from_bar(port_bar),
    };
    let currents: Vec<Currents> = time_s.iter().copied().map(currents).collect();
    let trace = simulate(model, rig, oil_temperature_c, time_s, &currents);
    trace.channel(Channel::Flow).to_vec()
}

/// A current that rests, rises slowly, and falls as slowly: 0.05 A/s between 1.5 and 2.0 A.
fn triangle_a(time_s: f64) -> f64 {
    1.5 + 0.05 * (10.0 - (time_s - 12.0).abs()).max(0.0)
}

/// Choudhury's spool with a triangular current: it stays at 1.5 A until the current has changed by a band, then follows
/// with half of the remaining band as lag, and does the same on the way down from the peak.
#[test]
fn a_following_spool_sticks_where_the_current_stood_or_turned() {
    let (band_a, jump) = (0.08, 0.6);
    let behind_a = 0.5 * (1.0 - jump) * band_a;
    let spool_a = |time_s: f64| {
        let current_a = triangle_a(time_s);
        let (rises, peak_a) = (time_s < 12.0, 2.0);
        match (rises, current_a) {
            // It started from zero, and rests with the lag with which it followed.
            (true, a) if a - 1.5 <= band_a => 1.5 - behind_a,
            (true, a) => a - behind_a,
            (false, a) if peak_a - a <= band_a => peak_a - behind_a,
            (false, a) => a + behind_a,
        }
    };
    let time_s: Vec<f64> = (0..1050).map(|k| f64::from(k) * 0.02).collect();
    let lift = |time_s: f64| Currents {
        lift_a: triangle_a(time_s),
        lower_a: 0.0,
    };
    let sticking = model("spool-stiction/following", &[band_a, jump]);
    let shown = flow_lpm(&sticking, 20.0, 40.0, &time_s, lift);
    let nominal = hitch_model_file::nominal();
    let moved = |time_s: f64| Currents {
        lift_a: spool_a(time_s),
        lower_a: 0.0,
    };
    let wanted = flow_lpm(&nominal, 20.0, 40.0, &time_s, moved);
    let at_a_jump = |time_s: f64| {
        [3.6, 13.6]
            .iter()
            .any(|jump_s| (time_s - jump_s).abs() < 0.05)
    };
    for ((time_s, shown), wanted) in time_s.iter().zip(shown).zip(wanted) {
        assert!(
            at_a_jump(*time_s) || (shown - wanted).abs() < 0.02,
            "{shown} l/min at {time_s} s, not {wanted}"
        );
    }
}

/// `tanh(2 lambda / critical)` by hand: 2 * 8 mm/A * 0.2 A * sqrt(2 * 5 bar / 877.3 kg/m3) / (nu * critical).
#[test]
fn a_narrow_gap_passes_less_when_the_oil_is_cold() {
    let lower_a = 1.34;
    let critical = 150.0;
    let still = |_: f64| Currents {
        lift_a: 0.0,
        lower_a,
    };
    let time_s = [0.0, 0.02];
    let nominal = hitch_model_file::nominal();
    let beyond_a = lower_a - nominal.constants().lower_valve.curve.threshold_a();
    for (oil_temperature_c, mm2_s) in [(20.0, 320.286), (40.0, 95.070), (60.0, 38.117)] {
        let speed_m_s = (2.0 * pa_from_bar(5.0) / 877.3_f64).sqrt();
        let flow_number = 0.008 * beyond_a * speed_m_s / (mm2_s * 1e-6);
        let discharge = (2.0 * flow_number / critical).tanh();
        let wide = flow_lpm(&nominal, 5.0, oil_temperature_c, &time_s, still)[1];
        let narrow = model("oil-viscosity/flow-number", &[critical]);
        let narrow = flow_lpm(&narrow, 5.0, oil_temperature_c, &time_s, still)[1];
        assert!(
            (narrow / wide / discharge - 1.0).abs() < 1e-4,
            "{oil_temperature_c} C: {} of the flow, not {discharge}",
            narrow / wide
        );
    }
}

/// Force balance of the spool by hand: with a force ratio of 0.3 at 15 bar its travel is multiplied by 1.3 / (1 + 0.3
/// dp / 15 bar) at another drop.
#[test]
fn a_flow_force_on_the_travel_reads_the_table_at_another_current() {
    let time_s = [0.0, 0.02];
    let nominal = hitch_model_file::nominal();
    let threshold_a = nominal.constants().lower_valve.curve.threshold_a();
    let pushed = model("flow-force/travel", &[0.3]);
    let flow_at = |model: &Model, port_bar: f64, lower_a: f64| {
        let still = |_: f64| Currents {
            lift_a: 0.0,
            lower_a,
        };
        flow_lpm(model, port_bar, 40.0, &time_s, still)[1]
    };
    for (port_bar, lower_a) in [(5.0, 1.5), (15.0, 2.0), (60.0, 2.0), (60.0, 3.0)] {
        let balance = 1.3 / (1.0 + 0.3 * port_bar / 15.0);
        let read_at_a = threshold_a + (lower_a - threshold_a) * balance;
        let wanted = flow_at(&nominal, port_bar, read_at_a);
        let shown = flow_at(&pushed, port_bar, lower_a);
        assert!(
            (shown - wanted).abs() < 1e-6,
            "{port_bar} bar: {shown}, not {wanted}"
        );
    }
}

/// The spool's equation of motion, integrated in very small steps: `w'' = omega^2 (I - w) - 2 damping omega w'`, omega
/// from the lag.
#[test]
fn a_swinging_spool_overshoots_as_its_equation_says() {
    let (lag_s, damping) = (0.06, 0.45);
    let omega_rad_s = 2.0 * damping / lag_s;
    let time_s: Vec<f64> = (0..100).map(|k| f64::from(k) * 0.02).collect();
    // Linear between the samples, like a log.
    let edge_a = |time_s: f64| 1.5 + 25.0 * (time_s - 0.2).clamp(0.0, 0.02);
    let step_s = 1e-5;
    let (mut place_a, mut speed_a_s, mut fine_s) = (1.5, 0.0, 0.0);
    let mut spool_a = Vec::new();
    for &at_s in &time_s {
        while fine_s < at_s - 0.5 * step_s {
            let pull = omega_rad_s * omega_rad_s * (edge_a(fine_s) - place_a);
            speed_a_s += step_s * (pull - 2.0 * damping * omega_rad_s * speed_a_s);
            place_a += step_s * speed_a_s;
            fine_s += step_s;
        }
        spool_a.push(place_a);
    }
    let highest_a = spool_a.iter().copied().fold(0.0, f64::max);
    assert!(highest_a > 2.05, "{highest_a} A is no overshoot");
    let lift = |lift_a: f64| Currents {
        lift_a,
        lower_a: 0.0,
    };
    let swinging = model("spool-lag/swinging", &[lag_s, damping]);
    let shown = flow_lpm(&swinging, 20.0, 40.0, &time_s, |t| lift(edge_a(t)));
    let sample = |time_s: f64| (time_s / 0.02).round() as usize;
    let nominal = hitch_model_file::nominal();
    let wanted = flow_lpm(&nominal, 20.0, 40.0, &time_s, |t| lift(spool_a[sample(t)]));
    for ((time_s, shown), wanted) in time_s.iter().zip(shown).zip(wanted) {
        assert!(
            (shown - wanted).abs() < 0.01,
            "{shown} l/min at {time_s} s, not {wanted}"
        );
    }
}

/// Dahl's friction by hand: the pressure at rest is that of the weight, plus the full friction after lifting, minus the
/// full friction after lowering; the vibration reduces the friction by a share per second.
#[test]
fn bristles_hold_at_rest_what_they_held_in_motion() {
    let (force_n, bending_mm, load_kg) = (450.0, 0.3, 150.0);
    let lift = |time_s: f64| {
        if (1.0..2.0).contains(&time_s) {
            1.8
        } else {
            0.0
        }
    };
    let lower = |time_s: f64| {
        if (4.0..4.5).contains(&time_s) {
            1.7
        } else {
            0.0
        }
    };
    let time_s: Vec<f64> = (0..350).map(|k| f64::from(k) * 0.02).collect();
    let currents: Vec<Currents> = time_s
        .iter()
        .map(|&time_s| Currents {
            lift_a: lift(time_s),
            lower_a: lower(time_s),
        })
        .collect();
    let rig = Rig::Hitch(HitchRig {
        load_kg,
        start_angle_rad: 80f64.to_radians(),
    });
    for straightening_1_s in [0.0, 0.7] {
        let rough = model(
            "coulomb-friction/bristles",
            &[force_n, bending_mm, straightening_1_s * bending_mm],
        );
        let trace = simulate(&rough, rig, 40.0, &time_s, &currents);
        let beyond_weight_n = |sample: usize| {
            let angle_rad = trace.true_angle_deg[sample].to_radians();
            let dh_dx = rough.linkage().dh_dx(rough.linkage().piston_m(angle_rad));
            let weight_n = (load_kg + 30.0) * 9.81 * dh_dx;
            let pressure_pa = pa_from_bar(trace.channel(Channel::CylinderPressure)[sample]);
            pressure_pa * rough.constants().cylinder.area_m2() - weight_n
        };
        // The valves are closed from 2 s and from 4.5 s on.
        for (shut_s, later_s, sign) in [(2.02, 3.9, 1.0), (4.52, 6.9, -1.0)] {
            for at_s in [shut_s, later_s] {
                let left = (-straightening_1_s * (at_s - shut_s)).exp();
                let wanted_n = sign * force_n * left;
                let shown_n = beyond_weight_n((at_s / 0.02) as usize);
                assert!(
                    (shown_n - wanted_n).abs() < 0.04 * force_n,
                    "{shown_n} N at {at_s} s, not {wanted_n} N"
                );
            }
        }
    }
}

/// In motion the bristles act as plain dry friction, in the dynamic plant as well: the pressure equals that of the
/// other form.
#[test]
fn bristles_in_motion_are_dry_friction() {
    let time_s: Vec<f64> = (0..150).map(|k| f64::from(k) * 0.02).collect();
    let moving = |lift_a: f64, lower_a: f64| {
        let currents = vec![Currents { lift_a, lower_a }; time_s.len()];
        let rig = Rig::Hitch(HitchRig {
            load_kg: 150.0,
            start_angle_rad: 90f64.to_radians(),
        });
        ["coulomb-friction", "coulomb-friction/bristles"].map(|name| {
            let typical = AddedEffect::typical(effect(name));
            let model = hitch_model_file::dynamic().with_effects(vec![typical]);
            let trace = simulate(&model, rig, 40.0, &time_s, &currents);
            let pressure_bar = &trace.channel(Channel::CylinderPressure)[100..];
            pressure_bar.iter().sum::<f64>() / pressure_bar.len() as f64
        })
    };
    for (lift_a, lower_a) in [(1.5, 0.0), (0.0, 1.5)] {
        let [plain_bar, bristles_bar] = moving(lift_a, lower_a);
        assert!(
            (plain_bar - bristles_bar).abs() < 0.02,
            "{bristles_bar} bar, not {plain_bar} bar"
        );
    }
}

/// What dry friction can hold: the full force of each law, over the piston's area; a viscous force holds nothing.
#[test]
fn a_stuck_piston_carries_the_force_of_dry_friction() {
    let rig = Rig::Hitch(HitchRig {
        load_kg: 150.0,
        start_angle_rad: 90f64.to_radians(),
    });
    let held_n = |name: &str, values: &[f64]| {
        let model = model(name, values);
        let plant = Plant::new(&model, rig, 40.0, Currents::default());
        plant.dry_friction_pa() * model.constants().cylinder.area_m2()
    };
    let smooth_n = held_n("coulomb-friction", &[450.0]);
    assert!((smooth_n - 450.0).abs() < 0.01 * 450.0, "{smooth_n} N");
    let bristles_n = held_n("coulomb-friction/bristles", &[450.0, 0.3, 0.0]);
    assert!((bristles_n - 450.0).abs() < 1e-9, "{bristles_n} N");
    let viscous_n = held_n("viscous-friction", &[9000.0]);
    assert!(viscous_n < 1e-6, "{viscous_n} N");
}

/// A margin that decreases with the flow: `Q^2 / Q_table^2 = (drop - k Q) / drop`, a quadratic equation in the flow.
#[test]
fn a_compensator_that_droops_with_the_flow_leaves_the_flow_of_a_quadratic() {
    let (flow_share, slope, port_bar) = (0.15, 0.004, 30.0);
    let time_s: Vec<f64> = (0..200).map(|k| f64::from(k) * 0.02).collect();
    for lift_a in [1.4, 1.7, 2.0] {
        let lift = |_| Currents {
            lift_a,
            lower_a: 0.0,
        };
        let shown = |model: &Model| {
            let shown = flow_lpm(model, port_bar, 40.0, &time_s, lift);
            shown[shown.len() - 1]
        };
        let (full_lpm, pump_lpm) = (shown(&hitch_model_file::nominal()), 54.5 * 0.88);
        let (full_bar, left_bar) = (1.5, 1.5 - slope * port_bar);
        let lost_bar_lpm = flow_share * 4.0 / pump_lpm;
        let a = full_bar / (full_lpm * full_lpm);
        let root = (lost_bar_lpm * lost_bar_lpm + 4.0 * a * left_bar).sqrt();
        let expected_lpm = (root - lost_bar_lpm) / (2.0 * a);
        let drooping = shown(&model("compensator-droop/flow", &[flow_share, slope]));
        assert!(
            (drooping - expected_lpm).abs() < 1e-3,
            "{drooping} {expected_lpm}"
        );
    }
}

/// The deviation of the pump pressure from the margin above the port, and from the idle pressure afterwards, decays by
/// the same factor in every sample: `exp(-dt / lag)`.
#[test]
fn a_late_compensator_gets_to_its_pressure_as_its_equation_says() {
    const STEP_S: f64 = 0.01;
    let lag_s = 0.04;
    let time_s: Vec<f64> = (0..200).map(|k| STEP_S * f64::from(k)).collect();
    let currents: Vec<Currents> = time_s
        .iter()
        .map(|&t| Currents {
            lift_a: if (0.3..1.0).contains(&t) { 2.0 } else { 0.0 },
            lower_a: 0.0,
        })
        .collect();
    let rig = Rig::Flow {
        port_pressure_pa: pa_from_bar(50.0),
    };
    let model = model("compensator-droop/lagging", &[lag_s, 0.0, 0.0]);
    let trace = simulate(&model, rig, 40.0, &time_s, &currents);
    let pump_bar = trace.channel(Channel::PumpPressure);
    let left = (-STEP_S / lag_s).exp();
    for (from, sought_bar) in [(34, 54.0), (104, 4.0)] {
        for sample in from..from + 8 {
            let [before, after] = [sample, sample + 1].map(|at| pump_bar[at] - sought_bar);
            assert!(
                (after / before - left).abs() < 1e-6,
                "{sample}: {before} {after}"
            );
        }
    }
}

/// Virtual work at rest: only the load's part of the weight changes, and most at both ends.
#[test]
fn a_load_that_pitches_weighs_more_and_the_links_do_not() {
    let (share, slope, bow) = (0.1, 0.2, 0.5);
    let pitching = model("load-arm/load-only", &[share, slope, bow]);
    let plain = hitch_model_file::nominal();
    let dead_kg = plain.constants().masses.dead_weight_kg;
    for load_kg in [50.0, 250.0] {
        for start_angle_deg in [50.0, 90.0, 130.0] {
            let rig = Rig::Hitch(HitchRig {
                load_kg,
                start_angle_rad: f64::to_radians(start_angle_deg),
            });
            let held = |model: &Model| {
                let plant = Plant::new(model, rig, 40.0, Currents::default());
                (
                    plant.state().piston_m,
                    plant.reading().cylinder_pressure_bar,
                )
            };
            let ((piston_m, without_bar), (_, with_bar)) = (held(&plain), held(&pitching));
            let z = 2.0 * piston_m / plain.constants().cylinder.stroke_m - 1.0;
            let there = share * (1.0 + slope * z + bow * (1.5 * z * z - 0.5));
            let expected = 1.0 + there * load_kg / (load_kg + dead_kg);
            assert!((with_bar / without_bar - expected).abs() < 1e-9);
        }
    }
}

/// The shaft's inertia is specified at 150 kg and mid-stroke, where it is equivalent to inertia of the load. With a
/// lighter load the oscillation is slower, by the square root of the inertia.
#[test]
fn inertia_on_the_shaft_is_the_same_whatever_the_load() {
    let period_s = |form: &str, shape: &[f64], load_kg: f64| {
        let values = [&[0.5], shape].concat();
        let added = AddedEffect {
            effect: effect(form),
            values,
        };
        let model = hitch_model_file::dynamic().with_effects(vec![added]);
        let rig = Rig::Hitch(HitchRig {
            load_kg,
            start_angle_rad: f64::to_radians(89.0),
        });
        let mut plant = Plant::new(&model, rig, 40.0, Currents::default());
        let mut at_s = Vec::new();
        let mut before_m_s = 0.0;
        for step in 0..3000 {
            let time_s = 5e-4 * f64::from(step);
            let lift_a = if time_s < 0.1 { 1.8 } else { 0.0 };
            plant.step(
                Currents {
                    lift_a,
                    lower_a: 0.0,
                },
                5e-4,
            );
            let speed_m_s = plant.state().speed_m_s;
            if time_s > 0.5 && before_m_s < 0.0 && speed_m_s >= 0.0 {
                at_s.push(time_s - 5e-4 * speed_m_s / (speed_m_s - before_m_s));
            }
            before_m_s = speed_m_s;
        }
        (at_s[5] - at_s[0]) / 5.0
    };
    let plain = |load_kg| period_s("load-inertia", &[], load_kg);
    let on_shaft = |load_kg| period_s("load-inertia/shaft", &[1.0], load_kg);
    assert!((on_shaft(150.0) / plain(150.0) - 1.0).abs() < 2e-3);
    // (80 + 0.5 * 180) / (1.5 * 80), less the effect of the piston's own 20 kg.
    let expected = (170.0_f64 / 120.0).sqrt();
    assert!((on_shaft(50.0) / plain(50.0) / expected - 1.0).abs() < 5e-3);
}

/// The oil volume behind closed valves is constant: the piston moves by the change of the oil's and the hose's volume,
/// of which a share follows the recorded pressure with a lag (`W' = (share C p - W) / creep`).
#[test]
fn a_creeping_hose_takes_the_oil_that_the_piston_gives_up() {
    let (compliance_cm3_bar, share, creep_s) = (0.06, 0.6, 0.08);
    let creeping = AddedEffect {
        effect: effect("hose-compliance/creeping"),
        values: vec![compliance_cm3_bar, share, creep_s],
    };
    let model = hitch_model_file::dynamic().with_effects(vec![creeping]);
    let rig = Rig::Hitch(HitchRig {
        load_kg: 200.0,
        start_angle_rad: 80f64.to_radians(),
    });
    let mut plant = Plant::new(&model, rig, 40.0, Currents::default());
    let constants = model.constants();
    let (area_m2, step_s) = (constants.cylinder.area_m2(), 5e-4);
    let compliance_m3_pa = 1e-6 * compliance_cm3_bar / pa_from_bar(1.0);
    let mut last = plant.state();
    let mut wall_pa = last.pressure_pa;
    let (mut kept_m3, mut swing_m, mut error_m): (f64, f64, f64) = (0.0, 0.0, 0.0);
    // The spools have closed half a second after the current is off.
    let (off_s, shut_s) = (1.0, 1.5);
    for step in 1..5000 {
        let time_s = f64::from(step) * step_s;
        let lift_a = if time_s < off_s { 1.9 } else { 0.0 };
        let lower_a = 0.0;
        plant.step(Currents { lift_a, lower_a }, step_s);
        let now = plant.state();
        let mean_pa = 0.5 * (now.pressure_pa + last.pressure_pa);
        let crept_pa = (mean_pa - wall_pa) * (1.0 - (-step_s / creep_s).exp());
        wall_pa += crept_pa;
        let rise_pa = now.pressure_pa - last.pressure_pa;
        let oil_m3_pa = constants.cylinder.volume_m3(now.piston_m) / constants.oil.bulk_modulus_pa;
        if time_s > shut_s {
            kept_m3 += area_m2 * (now.piston_m - last.piston_m)
                + (oil_m3_pa + (1.0 - share) * compliance_m3_pa) * rise_pa
                + share * compliance_m3_pa * crept_pa;
            swing_m = swing_m.max((now.piston_m - last.piston_m).abs());
            error_m = error_m.max(kept_m3.abs() / area_m2);
        }
        last = now;
    }
    let swing_m_s = swing_m / step_s;
    assert!(swing_m_s > 1e-3, "{swing_m_s} m/s is no swing");
    assert!(error_m < 2e-7, "{error_m} m are missing");
}
