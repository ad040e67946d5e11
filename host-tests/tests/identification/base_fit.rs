//! Wrong base models, fitted to campaigns of the second rig with known constants. `HITCH_SEEDS=10` fits ten campaigns of each
//! kind.

use std::ffi::OsStr;

use hitch_identification::adequacy::lack_of_fit::cells;
use hitch_identification::adequacy::unsuitable_base::{is_unsuitable, wrong_share};
use hitch_identification::base::{BaseFit, fit_base_model};
use hitch_identification::constants::parameter::SENSORS;
use hitch_identification::constants::tolerances::Tolerances;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::fit_base;
use hitch_model_file::fitted_constants;
use hitch_plant::units::lpm_from_m3_s;
use hitch_plant::{Constants, Model, Valve, ValveCurve};
use host_tests::seeds::{cases, seeds};
use host_tests::short_moves::few_runs;
use truth_rigs::hidden_effects::starting_point;
use truth_rigs::second_rig::campaign_writer::campaign;
use truth_rigs::second_rig::draw::{Kind, Wish, draw};
use truth_rigs::second_rig::hidden::Fidelity;
use truth_rigs::second_rig::hideable::find;
use truth_rigs::second_rig::manoeuvres::Plan;
use truth_rigs::second_rig::test_stand::Family;

/// Largest error of a fitted model, sigma: noise.
const NOISE: f64 = 1.1;

/// First seed of the campaigns, and default number of them.
const FIRST_SEED: u64 = 700;
const FEW_SEEDS: u64 = 1;
/// The same with `HITCH_THOROUGH`.
const SEEDS: u64 = 3;

/// Relative errors of a declared model.
#[derive(Clone, Copy)]
struct Off {
    /// Flow curves at the current limit, growing from nothing at the threshold.
    curves: f64,
    /// Compensator margin.
    margin: f64,
    /// Pump flow.
    pump: f64,
}

const NOTHING: Off = Off {
    curves: 0.0,
    margin: 0.0,
    pump: 0.0,
};

const TYPICAL: Off = Off {
    curves: 0.1,
    margin: 0.1,
    pump: 0.05,
};

fn declared(truth: &Model, off: Off) -> Model {
    let mut constants = truth.constants().clone();
    for valve in Valve::BOTH {
        let curve = &mut valve.of_mut(&mut constants).curve;
        let threshold_a = curve.threshold_a();
        let currents_a = curve.currents_a().to_vec();
        let range_a = currents_a[currents_a.len() - 1] - threshold_a;
        let wrong = |(current_a, flow): (&f64, &f64)| {
            flow * (1.0 + off.curves * ((current_a - threshold_a) / range_a).max(0.0))
        };
        let flows = currents_a.iter().zip(curve.flows_m3_s()).map(wrong);
        *curve = ValveCurve::new(currents_a.clone(), flows.collect()).expect("a curve");
    }
    constants.compensator.margin_pa *= 1.0 + off.margin;
    constants.pump.theoretical_flow_m3_s *= 1.0 + off.pump;
    truth.with_constants(constants).expect("a linkage")
}

fn fitted(seed: u64, family: Family, plan: Plan, off: Off) -> (Model, BaseFit) {
    fitted_with(seed, family, plan, off, None)
}

/// With an effect of a size hidden in the campaign. A dynamic model is fitted to the short moves by day.
fn fitted_with(
    seed: u64,
    family: Family,
    plan: Plan,
    off: Off,
    hidden: Option<(&str, f64)>,
) -> (Model, BaseFit) {
    let case = draw(
        seed,
        &Wish {
            family,
            plan,
            fidelity: Some(Fidelity::Faithful),
            rough: Some(false),
            kind: Some(Kind::Nothing),
            effect: hidden.map(|(id, size)| (find(id).expect("a hideable effect"), Some(size))),
            known: |_| true,
        },
    );
    let truth = starting_point(family);
    let declared = declared(&truth, off);
    let measured = match family {
        Family::Steady => campaign(&case),
        Family::Dynamic => few_runs(campaign(&case)),
    };
    let experiment = Experiment::new(&measured, &declared);
    let fit = fit_base_model(&experiment, &declared, &Tolerances::default(), &|_| {});
    (truth, fit)
}

/// True value of a constant by its name in a model file; the sensors have no error.
fn true_value(name: &str, truth: &Model) -> f64 {
    if SENSORS.iter().any(|sensor| sensor.effect == name) {
        return 0.0;
    }
    let mut constants: Constants = truth.constants().clone();
    match name.split_once('.') {
        Some((table, "threshold_a")) => {
            let valves = Valve::BOTH.into_iter();
            let mut valves = valves.filter(|valve| valve.key() == table);
            let valve = valves.next().expect("a valve");
            valve.of(&constants).curve.threshold_a()
        }
        _ => {
            let (constant, _) = fitted_constants()
                .find(|(constant, _)| constant.name() == name)
                .expect("a constant");
            *(constant.place)(&mut constants) / constant.unit
        }
    }
}

/// Every determined quantity: its name, and whether its interval contains the truth.
fn covered(truth: &Model, fit: &BaseFit) -> Vec<(String, bool)> {
    let holds = |(low, high): (f64, f64), value: f64| low <= value && value <= high;
    let constants = fit.constants.iter().filter(|constant| constant.determined);
    let constants = constants.map(|constant| {
        let value = true_value(&constant.name, truth);
        (constant.name.clone(), holds(constant.interval, value))
    });
    let true_flows = Valve::BOTH.into_iter().flat_map(|valve| {
        let flows = valve.of(truth.constants()).curve.flows_m3_s();
        flows.iter().filter(|flow| **flow > 0.0)
    });
    let points = fit.curves.iter().zip(true_flows);
    let points = points.filter(|(point, _)| point.determined);
    let points = points.map(|(point, &flow)| {
        let name = format!("{} at {:.2} A", point.valve.key(), point.current_a);
        (name, holds(point.interval_lpm, lpm_from_m3_s(flow)))
    });
    constants.chain(points).collect()
}

/// Fits one campaign for each seed; returns the share of intervals that contain the truth.
fn coverage(family: Family, plan: Plan, off: Off) -> f64 {
    let (mut held, mut all) = (0, 0);
    for seed in FIRST_SEED..FIRST_SEED + seeds(cases(FEW_SEEDS, SEEDS)) {
        let (truth, fit) = fitted(seed, family, plan, off);
        let covered = covered(&truth, &fit);
        let missed: Vec<&str> = covered
            .iter()
            .filter(|(_, holds)| !holds)
            .map(|(name, _)| name.as_str())
            .collect();
        println!(
            "seed {seed}: error {:.2} -> {:.3} sigma, {} determined, not held: {missed:?}",
            fit.before.error(),
            fit.after.error(),
            covered.len()
        );
        assert!(fit.after.error() <= NOISE, "seed {seed}");
        assert!(!covered.is_empty(), "seed {seed}");
        held += covered.len() - missed.len();
        all += covered.len();
    }
    let share = f64::from(held as u32) / f64::from(all as u32);
    println!("{held} of {all} intervals hold the truth: {share:.3}");
    share
}

// REQ-DIAG-09
#[test]
fn a_declared_model_that_is_off_comes_back_to_the_truth() {
    assert!(coverage(Family::Steady, Plan::Lab, TYPICAL) >= 0.9);
}

#[test]
fn motion_determines_the_curves_without_a_flow_bench() {
    let (_, fit) = fitted(720, Family::Steady, Plan::Field, TYPICAL);
    let determined = fit.curves.iter().filter(|point| point.determined).count();
    println!(
        "error {:.2} -> {:.3} sigma, {determined} points determined",
        fit.before.error(),
        fit.after.error()
    );
    assert!(fit.after.error() <= NOISE);
    assert!(2 * determined >= fit.curves.len());
    assert!(coverage(Family::Steady, Plan::Field, TYPICAL) >= 0.9);
}

// REQ-DIAG-09
#[test]
fn nothing_off_leaves_every_constant_within_its_interval() {
    assert!(coverage(Family::Steady, Plan::Lab, NOTHING) >= 0.9);
}

#[test]
fn a_dynamic_model_that_is_off_leaves_noise() {
    let (truth, fit) = fitted(730, Family::Dynamic, Plan::Lab, TYPICAL);
    let covered = covered(&truth, &fit);
    let held = covered.iter().filter(|(_, holds)| *holds).count();
    println!(
        "error {:.2} -> {:.3} sigma, {held} of {} intervals hold the truth",
        fit.before.error(),
        fit.after.error(),
        covered.len()
    );
    for constant in &fit.constants {
        println!("{constant:?}, true {}", true_value(&constant.name, &truth));
    }
    assert!(fit.after.error() <= NOISE);
    let mut constants = fit.constants.iter();
    let margin = constants.find(|constant| constant.name == "compensator.margin_bar");
    let margin = margin.expect("a margin");
    assert!(margin.determined && (margin.fitted - 4.0).abs() < 0.1);
}

/// Errors of the sensors beside constants that are off.
#[test]
fn errors_of_the_sensors_are_fitted() {
    let errors = [
        ("pressure-sensor-offset", -2.0, -2.0),
        ("angle-sensor-gain", 0.02, 2.0),
        ("pressure-sensor-offset", 1.5, 1.5),
        ("angle-sensor-gain", -0.015, -1.5),
    ];
    for &(id, size, shown) in cases(&errors[..2], &errors) {
        let (_, fit) = fitted_with(740, Family::Steady, Plan::Lab, TYPICAL, Some((id, size)));
        println!(
            "{id} {size}: error {:.2} -> {:.3} sigma",
            fit.before.error(),
            fit.after.error()
        );
        let mut own = fit.constants.iter();
        let own = own.find(|constant| constant.name == id);
        let own = own.expect("a sensor");
        println!("{own:?}");
        assert!(fit.after.error() <= NOISE && own.determined);
        assert!((own.interval.0..=own.interval.1).contains(&shown));
        let mut added = fit.model.effects.iter();
        assert!(added.any(|added| added.effect.id() == id), "{id}");
    }
}

/// Another machine: bore, curves, margin and weights differ widely from those of the rig.
fn another_machine() -> Model {
    let mut constants = declared(
        &hitch_model_file::nominal(),
        Off {
            curves: 1.0,
            margin: 1.0,
            pump: 0.5,
        },
    )
    .constants()
    .clone();
    constants.cylinder.bore_m *= 0.7;
    constants.masses.dead_weight_kg *= 4.0;
    Model::new("another", constants).expect("a linkage")
}

// REQ-DIAG-08
#[test]
fn only_another_machine_is_an_unsuitable_base() {
    let folder = |name: &str| format!("{}/campaigns/{name}", env!("CARGO_MANIFEST_DIR"));
    let names = [
        "known-friction",
        "known-outside",
        "known-threshold",
        "clean-steady",
    ];
    for &name in cases(&names[..2], &names) {
        let campaign = hitch_campaign::Campaign::load(folder(name).as_ref());
        let campaign = campaign.expect("a shipped campaign");
        let unsuitable = |model: &Model| {
            let experiment = Experiment::new(&campaign, model);
            let base = fit_base(Problem::new(&experiment, model));
            let channels = [0, 1, 2, 3].map(|channel| base.channel_error(channel));
            println!(
                "{name}, {}: error {:.2} sigma, by channel {channels:.1?}, share of wrong cells {:.2}",
                model.name,
                base.error(),
                wrong_share(&cells(&experiment, &base))
            );
            is_unsuitable(&experiment, &base, &base)
        };
        assert!(!unsuitable(&hitch_model_file::nominal()), "{name}");
        let other = unsuitable(&another_machine());
        assert!(other, "{name}");
    }
}

// REQ-DIAG-08
#[test]
fn diagnose_first_reports_an_unsuitable_base() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("another.toml");
    std::fs::write(&file, hitch_model_file::to_toml(&another_machine())).expect("a file");
    let campaign = format!("{}/campaigns/clean-steady", env!("CARGO_MANIFEST_DIR"));
    let document = folder.path().join("said.json");
    let said = |name: &str, more: &[&OsStr]| {
        let mut command = host_tests::program::hitch();
        command.args([name, &campaign, "--model"]).arg(&file);
        let output = command.args(more).output().expect("it runs");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let diagnosis = said("diagnose", &["--json".as_ref(), document.as_ref()]);
    assert!(diagnosis.starts_with("The base model does not match this machine"));
    let written = std::fs::read_to_string(&document).expect("a document");
    assert!(written.contains("\"unsuitable_base\": true"));
    for text in [diagnosis, said("compare", &[])] {
        let last = text.lines().last().expect("a proposal");
        assert!(last.starts_with("  hitch model fit "), "{last}");
    }
}

#[test]
fn a_new_model_file_loads_and_errors_are_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("a file");
    };
    text(
        "lift.csv",
        "Strom [mA];Menge [l/min]\n0;0\n1200;0\n3000;35,5\n",
    );
    text("bad.csv", "current_a,flow_lpm\n0,0\n2,20\n1,30\n");
    let run = |arguments: &[&str]| {
        let output = host_tests::program::run(folder.path(), arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), said)
    };
    let new = [
        "model",
        "new",
        "--out",
        "my.toml",
        "--set",
        "cylinder.bore_mm=80",
    ];
    let (code, said) = run(&[&new[..], &["--lift-curve", "lift.csv"]].concat());
    assert_eq!(code, Some(0), "{said}");
    let model = hitch_model_file::read(&folder.path().join("my.toml")).expect("a model file");
    assert!((model.constants().cylinder.bore_m - 0.08).abs() < 1e-12);
    assert_eq!(
        model.constants().lift_valve.curve.currents_a(),
        [0.0, 1.2, 3.0]
    );
    let campaign = format!("{}/campaigns/clean-steady", env!("CARGO_MANIFEST_DIR"));
    let (code, said) = run(&["compare", &campaign, "--model", "my.toml"]);
    assert_eq!(code, Some(0), "{said}");
    for (wrong, expected) in [
        (
            ["--lower-curve", "bad.csv"],
            "bad.csv:4:1: the current does not rise",
        ),
        (
            ["--set", "cylinder.bore_mm=9999"],
            "a number from 5 to 1000",
        ),
        (
            ["--set", "cylinder.boar_mm=80"],
            "did you mean cylinder.bore_mm",
        ),
    ] {
        let (code, said) = run(&[&["model", "new"], &wrong[..]].concat());
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(expected), "{said}");
    }
}
