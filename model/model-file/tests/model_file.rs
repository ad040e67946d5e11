//! Tests of model files: writing and reading is exact bit for bit, and faults are reported with line and column.

use std::fs;

use hitch_effects::expression::{ParameterDefinition, TermDefinition};
use hitch_effects::{CATALOGUE, TermEffect, available};
use hitch_model_file::to_toml;
use hitch_plant::hooks::signals::Signals;
use hitch_plant::{AddedEffect, Model, Place, full_name};
use proptest::prelude::*;
use tempfile::TempDir;

fn read(text: &[u8]) -> Result<Model, String> {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("m.toml");
    fs::write(&path, text).unwrap();
    hitch_model_file::read(&path).map_err(|error| {
        error
            .to_string()
            .replace(&format!("{}/", dir.path().display()), "")
    })
}

fn fault(text: &str) -> String {
    read(text.as_bytes())
        .err()
        .unwrap_or_else(|| "no fault".to_owned())
}

/// A user-defined term whose texts need quoting.
fn term() -> &'static TermEffect {
    let size = ParameterDefinition {
        name: "c".to_owned(),
        unit: "N*s/m".to_owned(),
        meaning: "a \"drag\",\nas it were \\".to_owned(),
        null: 0.0,
        start: 1.0 / 3.0,
        low: -1e-9,
        high: 1e9,
    };
    let definition = TermDefinition {
        id: "drag".to_owned(),
        title: String::new(),
        place: Place::Friction,
        formula: "c *\n v".to_owned(),
        parameters: vec![size],
    };
    TermEffect::define(definition).unwrap()
}

#[test]
fn every_model_comes_back_bit_for_bit() {
    let with_term = hitch_model_file::dynamic().with_terms(vec![term()]);
    let catalogue = || available(&with_term).into_iter();
    let usual = catalogue().filter(|effect| effect.form().is_none());
    let usual = usual.map(AddedEffect::typical).collect();
    let other_forms = catalogue().filter(|effect| effect.form().is_some());
    let other_forms = other_forms.map(|form| vec![AddedEffect::typical(form)]);
    let with_effects = [usual].into_iter().chain(other_forms);
    let with_effects = with_effects.map(|effects| with_term.with_effects(effects));
    for model in [hitch_model_file::nominal(), hitch_model_file::dynamic()]
        .into_iter()
        .chain(with_effects)
    {
        let back = read(to_toml(&model).as_bytes()).unwrap();
        assert_eq!(back.constants(), model.constants());
        assert_eq!(back.name, model.name);
        assert_eq!(to_toml(&back), to_toml(&model));
        let values = |model: &Model| -> Vec<(String, Vec<f64>)> {
            model
                .effects
                .iter()
                .map(|added| (full_name(added.effect), added.values.clone()))
                .collect()
        };
        assert_eq!(values(&back), values(&model));
    }
}

#[test]
fn a_base_fills_in_what_is_not_written() {
    let model =
        read(b"format = 1\nbase = \"dynamic\"\n[relief_valve]\nset_pressure_bar = 180\n").unwrap();
    assert_eq!(model.name, "m");
    assert_eq!(model.constants().relief_valve.set_pressure_pa, 180e5);
    assert_eq!(
        model.constants().cylinder,
        hitch_model_file::dynamic().constants().cylinder
    );
}

#[test]
fn faults_have_a_line_and_a_column() {
    let whole = to_toml(&hitch_model_file::nominal());
    let with = |good: &str, bad: &str| {
        assert!(whole.contains(good), "{good}");
        fault(&whole.replacen(good, bad, 1))
    };
    let effect = |block: &str| {
        fault(&format!(
            "format = 1\nbase = \"nominal\"\n[[effect]]\n{block}\n"
        ))
    };
    let cases = [
        (
            with("set_pressure_bar", "set_pressure_psi"),
            "m.toml:10:1: unit psi is not known, this key has to be set_pressure_bar",
        ),
        (
            with("set_pressure_bar = 154", "set_pressure_bar = \"154\""),
            "m.toml:10:20: set_pressure_bar has to be a number, not the text",
        ),
        (
            with("set_pressure_bar = 154", "set_pressure_bar = -3"),
            "m.toml:10:20: set_pressure_bar = -3 is out of range",
        ),
        (
            with("set_pressure_bar = 154", ""),
            "m.toml:9:1: [relief_valve] has no set_pressure_bar",
        ),
        (
            with("[relief_valve]", "[relieve_valve]"),
            "m.toml:9:2: key \"relieve_valve\" is not known in the top level; did you mean relief_valve?",
        ),
        (
            with("[relief_valve]", "[[relief_valve]]"),
            "m.toml:9:1: relief_valve has to be a table",
        ),
        (
            with("\"steady\"", "\"static\""),
            "m.toml:3:12: dynamics \"static\" is not known",
        ),
        (
            with("format = 1", "format = 3"),
            "m.toml:1:10: format 3 is not known",
        ),
        (
            with("1.114, 1.126", "1.126, 1.114"),
            "m.toml:21:13: point 2 of a valve curve",
        ),
        (
            with(
                "lower_link_m = 0.7",
                "lower_link_m = 0.01\nlift_rod_m = 0.02\n#",
            ),
            "m.toml:",
        ),
        (
            with("rocker_arm_m = 0.11", "rocker_arm_m = 0.01"),
            "m.toml:",
        ),
        (
            fault("format = 1\n"),
            "m.toml:1:1: [the top level] has no dynamics",
        ),
        (
            fault("format = 1\nbase = \"ideal\""),
            "m.toml:2:8: base \"ideal\" is not known",
        ),
        (
            fault("format = 1\ndynamics = \"steady\""),
            "m.toml:1:1: table [pump] is missing; add it, or a line base",
        ),
        (
            effect("id = \"lower-treshold-shift\"\nshift_a = 0.2"),
            "m.toml:4:6: effect \"lower-treshold-shift\" is not known; did you mean lower-threshold-shift?",
        ),
        (
            effect("id = \"lower-threshold-shift\"\nshift_ma = 200"),
            "m.toml:5:1: unit ma is not known, this key has to be shift_a",
        ),
        (
            effect("id = \"lower-threshold-shift\""),
            "m.toml:3:1: [[effect]] has no shift_a",
        ),
        (
            effect("id = \"lower-threshold-shift\"\nshift_a = 200"),
            "m.toml:5:11: shift_a = 200 is out of range",
        ),
        (
            effect(
                "id = \"lower-threshold-shift\"\nshift_a = 0.2\n[[effect]]\nid = \"lower-threshold-shift\"\nshift_a = 0.2",
            ),
            "m.toml:7:6: lower-threshold-shift is duplicated",
        ),
        (effect("shift_a = 0.2"), "m.toml:3:1: [[effect]] has no id"),
        (
            effect("id = \"oil-viscosity\"\nform = \"tanh\"\ncritical_flow_number = 100.0"),
            "m.toml:5:8: oil-viscosity has no form \"tanh\"; omit the line, or write one of: flow-number",
        ),
        (
            effect("id = \"lower-threshold-shift\"\nform = \"best\"\nshift_a = 0.2"),
            "m.toml:5:8: lower-threshold-shift has no form \"best\"; omit the line",
        ),
    ];
    for (fault, expected) in cases {
        let expected = expected.replace("[the top level]", "the top level");
        assert!(
            fault.starts_with(&expected),
            "expected {expected}\n     got {fault}"
        );
        assert_eq!(fault.lines().count(), 1, "{fault}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    /// A model file with arbitrary changes of its bytes is either read or rejected with a message of one line.
    #[test]
    fn mutations_never_panic(edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..3_u8), 1..6)) {
        let effects = vec![AddedEffect::typical(CATALOGUE[0]), AddedEffect::typical(term())];
        let mut bytes = to_toml(&hitch_model_file::dynamic().with_terms(vec![term()]).with_effects(effects)).into_bytes();
        for (place, byte, edit) in edits {
            let at = place.index(bytes.len());
            match edit {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, b'0' + byte % 10),
                _ => drop(bytes.remove(at)),
            }
        }
        if let Err(error) = read(&bytes) {
            prop_assert_eq!(error.lines().count(), 1);
        }
    }
}

/// A model file with user-defined terms.
const TERMS: &str = r#"format = 1
base = "dynamic"

[[term]]
id = "end-cushion"
title = "Cushion at the \"lower\" end"
place = "lower-flow-factor"
formula = "-c * ramp(1 - x / depth)"

[[term.parameter]]
name = "c"
meaning = "share of the flow that is held back at the end"
null = 0
start = 0.5
low = 0
high = 1

[[term.parameter]]
name = "depth"
unit = "mm"
start = 20
low = 5
high = 50

[[term]]
id = "creeping-leak"
place = "leakage"
formula = "g * p_cyl * (40[cSt] / nu)"

[[term.parameter]]
name = "g"
unit = "l/min/bar"
null = 0
start = 0.004
low = 0
high = 0.1

[[effect]]
id = "coulomb-friction"
force_n = 400

[[effect]]
id = "end-cushion"
c = 0.41
depth_mm = 22
"#;

#[test]
fn a_model_file_brings_its_terms_and_takes_fitted_values_back() {
    let mut model = read(TERMS.as_bytes()).unwrap();
    let ids: Vec<&str> = model.terms.iter().map(|term| term.id()).collect();
    assert_eq!(ids, ["end-cushion", "creeping-leak"]);
    assert_eq!(available(&model).last().unwrap().id(), "creeping-leak");
    assert_eq!(model.effects[1].values, [0.41, 22.0]);
    assert_eq!(model.terms[1].parameters()[0].key, "g_lpm_per_bar");
    assert_eq!(model.terms[0].title(), "Cushion at the \"lower\" end");
    assert_eq!(
        model.terms[0].equation(),
        "lower-flow-factor = -c * ramp(1 - x / depth)"
    );

    model.effects[1].values = vec![0.1 + 0.2, 1.0 / 0.07];
    model.effects.push(AddedEffect::typical(model.terms[1]));
    let back = read(to_toml(&model).as_bytes()).unwrap();
    for (read, written) in back.terms.iter().zip(&model.terms) {
        assert!(
            std::ptr::eq(*read, *written),
            "the same definition gives the same effect"
        );
    }
    let values = |model: &Model| -> Vec<(&str, Vec<f64>)> {
        model
            .effects
            .iter()
            .map(|added| (added.effect.id(), added.values.clone()))
            .collect()
    };
    assert_eq!(values(&back), values(&model));
    assert_eq!(to_toml(&back), to_toml(&model));
}

#[test]
fn a_term_acts_in_si_from_values_in_its_units() {
    let model = read(TERMS.as_bytes()).unwrap();
    let signals = Signals {
        travel_m: 0.011,
        ..Signals::default()
    };
    let cushion = TermEffect::of(model.terms[0])
        .unwrap()
        .function(&[0.4, 22.0]);
    assert!((cushion(&signals) + 0.2).abs() < 1e-15);
}

#[test]
fn faults_of_a_term_in_a_model_file_have_a_place() {
    let with = |good: &str, bad: &str| {
        assert!(TERMS.contains(good), "{good}");
        fault(&TERMS.replacen(good, bad, 1))
    };
    let cases = [
        (
            with("lower-flow-factor", "lower-flow"),
            "m.toml:7:9: place \"lower-flow\" is not known; did you mean lower-",
        ),
        (
            with("place =", "places ="),
            "m.toml:7:1: key \"places\" is not known in [[term]]; did you mean place?",
        ),
        (
            with("low = 0\nhigh = 1", "high = 1"),
            "m.toml:10:1: [[term.parameter]] has no low",
        ),
        (
            with("\nstart = 20", "\nnull = 0\nstart = 20"),
            "m.toml:21:1: key \"null\" is not known in [[term.parameter]]",
        ),
        (
            with("creeping-leak", "end-cushion"),
            "m.toml:26:6: end-cushion is duplicated; delete one of the two [[term]]",
        ),
        (
            with("c = 0.41", "c = 2"),
            "m.toml:44:5: c = 2 is out of range; the range is 0 to 1",
        ),
        (
            with("depth_mm = 22", ""),
            "m.toml:42:1: [[effect]] has no depth_mm",
        ),
        (
            with("\"-c * ramp(1 - x", "\"\"\"\n-c * ramp(1 - z"),
            "m.toml:",
        ),
        (
            with("\"-c * ramp(1 - x", "\"-c *\\tramp(1 - z"),
            "m.toml:8:11: name `z` is not known",
        ),
        (
            with("id = \"end-cushion\"\nc", "id = \"end-cushio\"\nc"),
            "m.toml:43:6: effect \"end-cushio\" is not known; did you mean end-cushion?",
        ),
    ];
    for (found, expected) in cases {
        assert!(
            found.starts_with(expected),
            "expected {expected}\n     got {found}"
        );
    }
}

const LOAD_SENSING: &str = "format = 1\nbase = \"dynamic\"\n[pump]\nkind = \"load-sensing\"\n\
    standby_pressure_bar = 22\nresponse_time_ms = 40\n[cylinder]\ncylinders = 2\nstroke_mm = 160\n[linkage]\n\
    stroke_mm = [0, 50, 100, 160]\nangle_deg = [45, 72.5, 101, 136]\nheight_mm = [-855.6, -640, -425, -170]\n";

#[test]
fn another_machine_comes_back_bit_for_bit() {
    let model = read(LOAD_SENSING.as_bytes()).unwrap();
    let constants = model.constants();
    assert_eq!(constants.cylinder.count, 2);
    assert_eq!(constants.pump.kind, hitch_plant::PumpKind::LoadSensing);
    assert!((constants.pump.standby_pressure_pa - 22e5).abs() < 1e-6);
    assert!((model.linkage().at(0.05).rocker_angle_rad.to_degrees() - 72.5).abs() < 0.01);
    let back = read(to_toml(&model).as_bytes()).unwrap();
    assert_eq!(back.constants(), constants);
    assert_eq!(to_toml(&back), to_toml(&model));
    let template = hitch_model_file::Template::of("copy", &model)
        .text()
        .unwrap();
    assert_eq!(read(template.as_bytes()).unwrap().constants(), constants);
}

#[test]
fn faults_of_another_machine_are_told() {
    for (from, to, said) in [
        ("load-sensing", "axial", "kind \"axial\" is not known"),
        ("standby_pressure_bar = 22\n", "", "standby_pressure_bar"),
        ("cylinders = 2", "cylinders = 1.5", "not a whole number"),
        ("cylinders = 2", "cylinders = 9", "m.toml:8:13"),
        ("101", "70", "point 3 does not"),
        ("101, ", "", "same number"),
        ("height_mm", "rocker_arm_m = 1\nheight_mm", "rocker_arm_m"),
        ("height_mm = [-855.6, -640, -425, -170]", "", "height_mm"),
        (
            "stroke_mm = 160",
            "stroke_mm = 170",
            "covers 0.0 to 160.0 mm",
        ),
        ("kind = \"load-sensing\"\n", "", "standby_pressure_bar"),
    ] {
        let fault = fault(&LOAD_SENSING.replacen(from, to, 1));
        assert!(fault.contains(said), "{to}: {fault}");
    }
}
