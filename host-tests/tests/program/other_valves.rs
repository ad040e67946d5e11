//! A machine whose valves end at 1.6 A and whose hitch moves from 28 to 123 degrees: nothing is of the paper's machine.

use std::fs;
use std::io::Write as _;
use std::path::Path;
use std::process::Stdio;
use std::time::Instant;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::limit::Limit;
use hitch_identification::search::options::Options;
use hitch_plant::Dynamics;
use hitch_results::closed_loop::rebuild::Rebuild;
use hitch_results::closed_loop::{Scenario, first_missed};
use hitch_results::explanation::Found;
use host_tests::program::{hitch, run};
use serde_json::Value;
use truth_rigs::category_three::files::write;

/// Largest current of the valves, A.
const LARGEST_A: f64 = 1.6;

fn succeed(folder: &Path, line: &str) -> String {
    let output = run(folder, &line.split_whitespace().collect::<Vec<_>>());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{line}: {said}");
    String::from_utf8(output.stdout).unwrap()
}

/// The files of the machine, and its model `sheet.toml`.
fn machine() -> tempfile::TempDir {
    let dir = tempfile::tempdir().unwrap();
    write(&dir.path().join("machine")).unwrap();
    succeed(
        dir.path(),
        "model new --from dynamic --pump load-sensing --lift-curve machine/lift_valve.csv \
         --lower-curve machine/lowering_valve.csv --linkage-table machine/linkage.csv \
         --set cylinder.cylinders=2 --set cylinder.bore_mm=90 --set pump.theoretical_flow_lpm=99 \
         --set lift_valve.reference_drop_bar=17 --set lower_valve.reference_drop_bar=50 --yes --out sheet.toml",
    );
    dir
}

/// The numbers in a text.
fn numbers(text: &str) -> Vec<f64> {
    let words = text.split([' ', ',', '[', ']']);
    words.filter_map(|word| word.parse().ok()).collect()
}

#[test]
fn groups_of_the_current_are_between_the_thresholds_and_ends_of_the_machines_valves() {
    let dir = machine();
    succeed(dir.path(), "import machine/new_400kg.mf4 --out c --yes");
    let document = succeed(dir.path(), "compare c --model sheet.toml --json -");
    let document: Value = serde_json::from_str(&document).unwrap();
    let cells = document["cells"].as_array().unwrap().iter();
    let parts =
        cells.filter(|cell| cell["by"] == "current" && cell["channel"] == "pump_pressure_bar");
    let parts: Vec<&str> = parts.map(|cell| cell["part"].as_str().unwrap()).collect();
    println!("{parts:?}");
    for valve in ["lift", "lower"] {
        let own = parts.iter().filter(|part| part.starts_with(valve));
        let limits: Vec<f64> = own.flat_map(|part| numbers(part)).collect();
        assert!(
            limits.iter().all(|limit| (0.4..LARGEST_A).contains(limit)),
            "{limits:?}"
        );
        let mut different = limits.clone();
        different.sort_by(f64::total_cmp);
        different.dedup();
        assert!(different.len() >= 3, "{parts:?}");
    }
}

#[test]
fn the_valve_map_ends_where_the_curves_of_the_valves_end() {
    let dir = machine();
    succeed(dir.path(), "calibrate sheet.toml --out c.toml");
    let text = fs::read_to_string(dir.path().join("c.toml")).unwrap();
    for valve in ["[lift]", "[lower]"] {
        let (_, table) = text.split_once(&format!("{valve}\n")).unwrap();
        let mut lines = table.lines();
        let line = lines.find(|line| line.starts_with("current_a")).unwrap();
        let currents_a = numbers(line);
        let last_a = currents_a[currents_a.len() - 1];
        assert!(
            currents_a[0] > 0.35 && (last_a - LARGEST_A).abs() < 0.01,
            "{currents_a:?}"
        );
    }
}

/// The closed loop after an explanation has this machine, and not the paper's: its cylinders, valves and loads.
#[test]
fn the_rebuilt_map_drives_the_machine_of_the_model() {
    let dir = machine();
    succeed(dir.path(), "import machine/new_400kg.mf4 --out c --yes");
    let model = hitch_model_file::named(dir.path().join("sheet.toml").to_str().unwrap()).unwrap();
    let campaign = Campaign::load_with(&dir.path().join("c"), model.linkage()).unwrap();
    // Quasi-static, as a model from data sheets may be: the loop adds the dynamics that it declares.
    let model = model.quasi_static();
    // Without effects: only the machine counts here.
    let options = Options {
        limit: Limit {
            deadline: Some(Instant::now()),
            requested: None,
        },
        ..Options::default()
    };
    let found = Found::new(
        Experiment::new(&campaign, &model),
        model.clone(),
        options,
        &|_| {},
    );
    let rebuild = Rebuild::new(&found, Scenario::Quick).unwrap();
    let (rig, own) = (rebuild.rig.constants(), model.constants());
    assert_eq!(rig.dynamics, Dynamics::Dynamic);
    assert_eq!(
        (&rig.cylinder, &rig.pump, &rig.lift_valve.curve),
        (&own.cylinder, &own.pump, &own.lift_valve.curve)
    );
    let piston_area = (own.cylinder.area_m2() * 1e6).round();
    for calibration in [&rebuild.nominal, &rebuild.rebuilt] {
        let hydraulics = &calibration.hydraulics;
        assert_eq!(f64::from(hydraulics.piston_area.0), piston_area);
    }
    for run in [&rebuild.before, &rebuild.after] {
        let is_usual = |load_kg: f64| model.usual_loads_kg().contains(&load_kg);
        assert!(run.results.iter().all(|result| is_usual(result.load_kg)));
        assert!(first_missed(run).is_none(), "{:?}", run.results);
    }
}

#[test]
fn the_lever_of_the_ecu_has_the_travel_of_the_hitch() {
    let dir = machine();
    let mut child = hitch()
        .args(["ecu", "--host", "--model", "sheet.toml", "--load", "400"])
        .current_dir(dir.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    input.write_all(b"lever 144\nlever 120\nquit\n").unwrap();
    drop(input);
    let output = child.wait_with_output().unwrap();
    let said =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    let said = said.concat();
    assert!(
        said.contains("`144` has to be a number from 35 to 133"),
        "{said}"
    );
    assert!(!said.contains("`120`"), "{said}");
}
