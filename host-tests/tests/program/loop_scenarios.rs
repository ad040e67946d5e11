//! `hitch loop`: moves that never arrive, oil temperatures, and the buttons.

use std::path::Path;

use host_tests::html_report::{assert_self_contained, plots, samples};
use host_tests::program::run;
use serde_json::Value;

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The document of `hitch loop`, which has to succeed.
fn document(folder: &Path, options: &str) -> Value {
    let arguments = format!("loop {options} --json -");
    let output = run(folder, &arguments.split(' ').collect::<Vec<_>>());
    assert!(output.status.success(), "{}", text(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn a_move_that_never_arrives_is_an_error_with_its_cause_after_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let map = "format = 1\n[position]\nupper_limit_deg = 95\n";
    std::fs::write(folder.path().join("limited.toml"), map).unwrap();
    let leak = hitch_effects::find("lowering-leakage").expect("in the catalogue");
    let mut leak = hitch_plant::AddedEffect::typical(leak);
    leak.values[0] = 0.03;
    let leaking = hitch_model_file::dynamic().with_effects(vec![leak]);
    std::fs::write(
        folder.path().join("leaking.toml"),
        hitch_model_file::to_toml(&leaking),
    )
    .unwrap();
    for (more, cause) in [
        ("--load 2000", "the pump cannot lift this load"),
        (
            "--load 150 --calibration limited.toml",
            "limits the set point to 95.0 deg",
        ),
        // The fault is over at the end: the controller is locked.
        ("--load 250 --model leaking.toml", "reports `sinking`"),
    ] {
        let arguments = format!("loop --scenario quick {more}");
        let output = run(folder.path(), &arguments.split(' ').collect::<Vec<_>>());
        let (table, error) = (text(&output.stdout), text(&output.stderr));
        println!("{table}{error}");
        assert_eq!(output.status.code(), Some(2), "{error}");
        assert!(table.contains("moves never arrived"), "{table}");
        assert_eq!(error.lines().count(), 1, "{error}");
        assert!(
            error.contains(" never arrives (") && error.contains(cause),
            "{error}"
        );
    }
}

#[test]
fn oil_temperatures_of_the_moves_are_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let document = document(
        folder.path(),
        "--scenario quick --loads 50,150 --oil-temperatures=10,70",
    );
    let moves = document["moves"].as_array().unwrap();
    assert_eq!(moves.len(), 2 * 2 * 4);
    let time_s = |load_kg: f64, oil_c: f64| {
        let of = |result: &&Value| {
            result["load_kg"] == load_kg
                && result["oil_temperature_c"] == oil_c
                && result["to_deg"].as_f64() > result["from_deg"].as_f64()
        };
        moves
            .iter()
            .filter(of)
            .map(|one| one["time_s"].as_f64().unwrap())
            .sum::<f64>()
    };
    for load_kg in [50.0, 150.0] {
        let (cold, hot) = (time_s(load_kg, 10.0), time_s(load_kg, 70.0));
        println!("{load_kg} kg: lifts take {cold:.3} s with cold oil, {hot:.3} s with hot oil");
        assert!(cold > 0.0 && hot > 0.0 && cold != hot);
    }
    for bad in ["hot", "200", ""] {
        let output = run(folder.path(), &["loop", "--oil-temperatures", bad]);
        assert_eq!(output.status.code(), Some(2), "{bad}");
        assert!(output.stdout.is_empty());
    }
}

// REQ-MODE-03
#[test]
fn the_button_is_driven_in_both_directions_at_its_speeds() {
    let folder = tempfile::tempdir().unwrap();
    let document = document(folder.path(), "--scenario rate --oil-temperatures 10,40,70");
    let presses = document["presses"].as_array().unwrap();
    assert_eq!(presses.len(), 3 * 3 * 3 * 2);
    for press in presses {
        let figure = |name: &str| {
            press[name]
                .as_f64()
                .unwrap_or_else(|| panic!("{name}: {press}"))
        };
        assert!((figure("speed_ratio") - 1.0).abs() < 0.05, "{press}");
        assert!(
            figure("start_delay_s") > 0.0 && figure("start_delay_s") < 1.0,
            "{press}"
        );
        assert!(
            figure("stop_delay_s") >= 0.0 && figure("stop_delay_s") < 2.0,
            "{press}"
        );
    }
    // A slower ramp starts later.
    let start_s = |options: &str| {
        let output = run(folder.path(), &options.split(' ').collect::<Vec<_>>());
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        document["presses"][4]["start_delay_s"].as_f64().unwrap()
    };
    let usual_s = start_s("loop --scenario rate --load 150 --json -");
    let slow_s = start_s("loop --scenario rate --load 150 --set rate.rate_slope=10 --json -");
    println!("half of 15 deg/s after {usual_s} s; with a third of the slope after {slow_s} s");
    assert!(slow_s > usual_s + 0.3);
}

/// The lines of the first row of a plot, by name.
fn lines(plot: &Value) -> Vec<(&str, Vec<f64>)> {
    let lines = plot["rows"][0]["lines"].as_array().unwrap().iter();
    lines
        .map(|line| (line["name"].as_str().unwrap(), samples(&line["y"])))
        .collect()
}

#[test]
fn variants_of_a_calibration_are_driven_and_shown_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let variants = "--variant soft:position.approach_gain=15 \
                    --variant slow:position.lift_speed=30,position.lower_speed=30";
    let options = format!("--scenario quick --load 150 {variants} --report v.html");
    let document = document(folder.path(), &options);
    let own = &document["variants"];
    assert_eq!(own[0]["name"], "soft");
    assert_eq!(own[1]["settings"][1], "position.lower_speed=30");
    let ratio = |of: &Value| of["summary"]["ratio_p95"].as_f64().unwrap();
    let [base, soft, slow] = [&document, &own[0], &own[1]].map(ratio);
    println!("time ratio, 95 %: {base:.2}, soft {soft:.2}, slow {slow:.2}");
    assert!(soft > base && slow > base + 0.5);
    let alone = self::document(
        folder.path(),
        "--scenario quick --load 150 --set position.approach_gain=15",
    );
    assert_eq!(alone["moves"], own[0]["moves"], "as set by hand");

    let html = std::fs::read_to_string(folder.path().join("v.html")).unwrap();
    assert_self_contained(&html);
    let plots = plots(&html);
    assert_eq!(plots.len(), document["moves"].as_array().unwrap().len());
    for plot in &plots {
        let lines = lines(plot);
        let names: Vec<&str> = lines.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["set point", "base", "soft", "slow"]);
        assert!(lines[1].1 != lines[2].1 && lines[2].1 != lines[3].1);
    }
    let arguments = format!("loop --scenario quick --load 150 {variants}");
    let output = run(
        folder.path(),
        &arguments.split_whitespace().collect::<Vec<_>>(),
    );
    let said = text(&output.stdout);
    let head = said.lines().find(|line| line.contains("figure")).unwrap();
    let names: Vec<&str> = head.split_whitespace().collect();
    assert_eq!(names, ["figure", "base", "soft", "slow"], "{said}");
    assert!(
        said.lines().all(|line| line.chars().count() <= 80),
        "{said}"
    );
}

#[test]
fn a_wrong_variant_is_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    for (bad, why) in [
        (&["soft"][..], "give a name and settings"),
        (&["base:position.creep_speed=3"], "choose another name"),
        (&["soft:position.kd=1"], "--variant soft: "),
        (&["soft:position.approach_gain=1e6"], "--variant soft: "),
        (
            &["a:position.creep_speed=3", "a:position.creep_speed=4"],
            "used twice",
        ),
    ] {
        let mut arguments = vec!["loop", "--scenario", "quick"];
        arguments.extend(bad.iter().flat_map(|variant| ["--variant", *variant]));
        let output = run(folder.path(), &arguments);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(why) && said.lines().count() == 1, "{said}");
        assert!(output.stdout.is_empty());
    }
}

#[test]
fn the_report_of_the_button_has_its_speed_with_each_calibration() {
    let folder = tempfile::tempdir().unwrap();
    let options = "--scenario rate --load 150 --variant late:rate.rate_slope=10 --report r.html";
    let document = document(folder.path(), options);
    let html = std::fs::read_to_string(folder.path().join("r.html")).unwrap();
    assert_self_contained(&html);
    let plots = plots(&html);
    let presses = document["presses"].as_array().unwrap();
    assert_eq!(plots.len(), presses.len());
    for (plot, press) in plots.iter().zip(presses) {
        let lines = lines(plot);
        let names: Vec<&str> = lines.iter().map(|(name, _)| *name).collect();
        assert_eq!(names, ["requested", "base", "late"]);
        // The largest drawn speed is the overshoot of the document.
        let rate = press["rate_deg_per_s"].as_f64().unwrap();
        let share = lines[1]
            .1
            .iter()
            .map(|speed| speed / rate)
            .fold(0.0, f64::max);
        let told = 1.0 + press["speed_overshoot"].as_f64().unwrap();
        assert!(
            told == 1.0 || (share - told).abs() < 0.02,
            "{share} {press}"
        );
    }
}

// REQ-MODE-10
#[test]
fn quick_lift_raises_and_returns_to_the_lever_without_overshoot() {
    let folder = tempfile::tempdir().unwrap();
    let document = document(folder.path(), "--scenario quick-lift");
    let moves = document["moves"].as_array().unwrap();
    assert_eq!(moves.len(), 3 * 3 * 2);
    let raised_deg = f64::from(
        hitch_quantities::Calibration::nominal()
            .operator
            .quick_lift_angle
            .0,
    ) * 1e-3;
    for pair in moves.chunks(2) {
        assert_eq!(pair[0]["to_deg"], raised_deg, "{}", pair[0]);
        assert_eq!(pair[1]["from_deg"], raised_deg, "{}", pair[1]);
        assert_eq!(pair[0]["from_deg"], pair[1]["to_deg"]);
        for driven in pair {
            assert_eq!(driven["arrived"], true, "{driven}");
            assert!(driven["overshoot_deg"].as_f64().unwrap() < 0.3, "{driven}");
            assert!(driven["ratio"].as_f64().unwrap() < 1.5, "{driven}");
        }
    }
}

#[test]
fn scenarios_of_the_field_say_what_is_required_and_take_settings() {
    let folder = tempfile::tempdir().unwrap();
    let figures = |options: &str| {
        let document = document(folder.path(), options);
        let figures = document["field"].as_array().unwrap().clone();
        assert!(document["moves"].as_array().unwrap().is_empty());
        figures
    };
    let met = |figure: &Value| {
        let required = figure["required"].as_f64();
        required.is_none_or(|most| figure["value"].as_f64().is_some_and(|value| value <= most))
    };
    let slip = figures("--scenario slip --report slip.html");
    assert!(slip.iter().all(met), "{slip:?}");
    let report = std::fs::read_to_string(folder.path().join("slip.html")).unwrap();
    assert_self_contained(&report);
    // A guard that may raise the hitch by half a degree only lets the wheels slip more, in percentage points.
    let weak = figures("--scenario slip --set slip.most_raise=0.5");
    let [guarded, weak] = [&slip, &weak].map(|figures| figures[1]["value"].as_f64().unwrap());
    assert!(weak > guarded + 1.0, "{guarded} {weak}");
    let output = run(
        folder.path(),
        &["loop", "--scenario", "depth", "--load", "600"],
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("leave --load"));
}
