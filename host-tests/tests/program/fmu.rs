//! `hitch export-fmu`: units for co-simulation, checked by FMPy, and equal to the commands that simulate the same.
//!
//! FMPy is installed once, under the target folder; on a machine without Python or network these tests say so and are
//! left out, except in continuous integration (`CI` is set).

use std::fmt::Write as _;
use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use hitch_closed_loop::{ClosedLoop, Coil, SUPPLY_V, Sample};
use hitch_plant::{AddedEffect, Currents, Model, Solenoid};
use hitch_quantities::{Calibration, Inputs};
use host_tests::program::{hitch, run};
use host_tests::python::{installed, run as said, scripts};
use host_tests::seeds::cases;

/// The seed of the first move of `hitch loop`.
const SEED: u64 = 0x5eed_0001;
/// The steps of a move of `hitch loop`: picked up, then watched.
const PICK_UP_STEPS: usize = 500;
const RUN_STEPS: usize = 64_000;

/// The Python that has FMPy, or nothing on a machine where that may be.
pub fn python() -> Option<&'static Path> {
    static PYTHON: OnceLock<Option<PathBuf>> = OnceLock::new();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    PYTHON
        .get_or_init(|| installed("fmpy.txt", folder))
        .as_deref()
}

/// Runs a script in a folder and returns its output.
pub fn script(python: &Path, folder: &Path, script: &Path, arguments: &[&str]) -> String {
    let cache = Path::new(env!("CARGO_TARGET_TMPDIR")).join("python-cache");
    let mut command = Command::new(python);
    let command = command.arg(script).args(arguments).current_dir(folder);
    said(command.env("PYTHONPYCACHEPREFIX", cache)).unwrap_or_else(|reason| panic!("{reason}"))
}

/// Runs `hitch`, which has to succeed; what it printed.
fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// Exports a unit.
pub fn export(folder: &Path, arguments: &[&str]) {
    succeed(folder, &[&["export-fmu"], arguments].concat());
}

/// A folder with the units of the dynamic plant and of the nominal controller.
pub fn units() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    export(folder.path(), &["dynamic", "--out", "plant.fmu"]);
    let controller = ["--controller", "--out", "controller.fmu"];
    export(folder.path(), &controller);
    folder
}

/// The dynamic plant with every effect at its typical size.
pub fn with_every_effect(name: &str) -> Model {
    let effects = hitch_effects::CATALOGUE
        .iter()
        .filter(|effect| effect.form().is_none())
        .map(|effect| AddedEffect::typical(*effect))
        .collect();
    let mut model = hitch_model_file::dynamic().with_effects(effects);
    model.name = name.to_owned();
    model
}

/// A log of the campaign that comes with the program.
fn log(name: &str) -> String {
    let data = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../workbench/data/demonstration"
    );
    format!("{data}/{name}")
}

/// The numbers of a table without its header.
fn table(path: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(path).unwrap();
    let numbers = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    text.lines().skip(1).map(numbers).collect()
}

/// Largest difference of the last `columns` columns of two tables; what is not a number in one is not compared.
fn largest_difference(one: &Path, other: &Path, columns: usize) -> f64 {
    let (one, other) = (table(one), table(other));
    assert_eq!(one.len(), other.len());
    let rows = one.iter().zip(&other);
    let pairs = rows.flat_map(|(a, b)| a.iter().rev().zip(b.iter().rev()).take(columns));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn an_importer_finds_no_fault_in_a_unit() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let model = folder.path().join("own <&> \"model\".toml");
    let every = with_every_effect("own <&> \"model\"");
    fs::write(&model, hitch_model_file::to_toml(&every)).unwrap();
    let model = model.to_str().unwrap();
    let folder = units();
    export(folder.path(), &[model, "--out", "every.fmu"]);
    let units = ["every.fmu", "controller.fmu", "plant.fmu"];
    for &unit in cases(&units[..2], &units) {
        let mut command = Command::new(python);
        let command = command.args(["-m", "fmpy", "validate", unit]);
        let said = said(command.current_dir(folder.path())).unwrap();
        assert_eq!(said.trim(), "No problems found.", "{unit}");
    }
}

#[test]
fn the_same_content_makes_the_same_unit() {
    let [one, other] = [units(), units()];
    for unit in ["plant.fmu", "controller.fmu"] {
        let bytes = |folder: &tempfile::TempDir| fs::read(folder.path().join(unit)).unwrap();
        assert!(bytes(&one) == bytes(&other), "{unit}");
    }
}

#[test]
fn an_imported_plant_is_the_simulated_one() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name);
    let typical = |id: &str| AddedEffect::typical(hitch_effects::find(id).unwrap());
    let sticky = hitch_model_file::nominal().with_effects(
        [
            "solenoid-hysteresis",
            "coulomb-friction",
            "angle-sensor-lag",
        ]
        .map(typical)
        .to_vec(),
    );
    fs::write(place("sticky.toml"), hitch_model_file::to_toml(&sticky)).unwrap();
    let logs = [
        (
            "lift_1.5A_050kg.csv",
            ["--load", "50", "--start-angle", "60"],
            ["load_kg=50", "start_angle_deg=60"],
        ),
        (
            "duty_150kg_62C.csv",
            ["--oil-temperature", "62", "--start-angle", "75"],
            ["oil_temperature_c=62", "start_angle_deg=75"],
        ),
        (
            "flow_lower_040bar.csv",
            ["--port-pressure", "40", "--oil-temperature", "30"],
            ["flow_bench=1", "port_pressure_bar=40"],
        ),
    ];
    // By day each model and each log once.
    for (model, one) in [("dynamic", 0), ("sticky.toml", 1), ("nominal", 2)] {
        export(folder.path(), &[model, "--out", "own.fmu"]);
        for &(name, options, parameters) in cases(&logs[one..=one], &logs) {
            let log = log(name);
            let simulate = ["simulate", "--model", model, "--inputs", &log];
            let simulate = [&simulate[..], &options, &["--out", "simulated.csv"]].concat();
            succeed(folder.path(), &simulate);
            let mut arguments = vec!["own.fmu", &log, "imported.csv", "ends"];
            arguments.extend(parameters);
            if options.contains(&"30") {
                arguments.push("oil_temperature_c=30");
            }
            let plant = scripts().join("fmu_plant.py");
            script(python, folder.path(), &plant, &arguments);
            let [simulated, imported] = ["simulated.csv", "imported.csv"].map(place);
            let apart = if name.starts_with("flow") {
                largest_difference_on_bench(&simulated, &imported)
            } else {
                largest_difference(&simulated, &imported, 4)
            };
            println!("{model}, {name}: {apart:.1e}");
            // What `hitch simulate` writes is rounded to five decimals.
            assert!(apart <= 0.6e-5, "{model}, {name}: {apart}");
        }
    }
}

/// The same of pressures and flow on a flow bench; the import has a column for the angle, which is not a number.
fn largest_difference_on_bench(simulated: &Path, imported: &Path) -> f64 {
    let (simulated, imported) = (table(simulated), table(imported));
    assert_eq!(simulated.len(), imported.len());
    assert!(imported.iter().all(|row| row[6].is_nan()));
    let rows = simulated.iter().zip(&imported);
    let pairs = rows.flat_map(|(a, b)| a.iter().zip(b).take(6));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// `hitch simulate` of a log without its angle, so that the hitch begins fully down as the unit does.
fn simulated_from_below(folder: &Path, log: &str) {
    let low_rad = hitch_model_file::dynamic().linkage().swing_rad().0;
    let start_deg = low_rad.to_degrees().to_string();
    let simulate = ["simulate", "--model", "dynamic", "--inputs", log];
    let options = ["--start-angle", &start_deg, "--out", "simulated.csv"];
    succeed(folder, &[&simulate[..], &options].concat());
}

#[test]
fn an_importer_that_gives_slopes_comes_to_the_same() {
    let Some(python) = python() else { return };
    let folder = units();
    let log = log("lift_2.1A_150kg.csv");
    simulated_from_below(folder.path(), &log);
    let arguments = ["plant.fmu", &log, "imported.csv", "slopes"];
    let plant = scripts().join("fmu_plant.py");
    script(python, folder.path(), &plant, &arguments);
    let [simulated, imported] =
        ["simulated.csv", "imported.csv"].map(|name| folder.path().join(name));
    let apart = largest_difference(&simulated, &imported, 4);
    println!("slopes: {apart:.1e}");
    assert!(apart <= 1e-5, "{apart}");
}

#[test]
fn the_own_simulation_of_an_importer_is_late_by_a_step() {
    let Some(python) = python() else { return };
    let log = log("lift_2.1A_150kg.csv");
    let folder = units();
    simulated_from_below(folder.path(), &log);
    let arguments = ["plant.fmu", &log, "imported.csv", "0.001"];
    let imported = scripts().join("fmu_simulated.py");
    script(python, folder.path(), &imported, &arguments);
    let [simulated, imported] =
        ["simulated.csv", "imported.csv"].map(|name| folder.path().join(name));
    let apart_deg = largest_difference(&simulated, &imported, 1);
    println!("FMPy's own simulation: {apart_deg:.1e} degree");
    // The hitch moves by 0.05 degree in a millisecond.
    assert!(apart_deg <= 0.1, "{apart_deg}");
}

/// A move of `hitch loop` from 87.5 to 92.5 degrees at 150 kg and 40 C: the first of `--scenario quick --load 150`.
fn quick_move(calibration: &str) -> Vec<Sample> {
    let model = hitch_model_file::dynamic();
    let nominal = Calibration::nominal().validate().unwrap();
    let settings: Vec<String> = calibration.split_whitespace().map(str::to_owned).collect();
    let calibration =
        hitch_controller_host::calibration_file::with_settings(&nominal, &settings).unwrap();
    let mut hitch = ClosedLoop::new(&model, &calibration, 150.0, 40.0, 87.5, SEED);
    // As an operator picks it up.
    let levers = std::iter::repeat_n(85.5, 100).chain(std::iter::repeat_n(87.5, 400));
    levers
        .chain(std::iter::repeat_n(92.5, RUN_STEPS))
        .map(|lever_deg| hitch.step(lever_deg))
        .collect()
}

/// An input line of `hitch controller` for a sample.
fn line(step: usize, inputs: &Inputs) -> String {
    let milli = |value: Option<i32>| {
        value.map_or(String::new(), |value| format!("{}", f64::from(value) / 1e3))
    };
    [
        format!("{:.3}", step as f64 * 1e-3),
        milli(inputs.lever.map(|value| value.0)),
        milli(inputs.rocker_angle.map(|value| value.0)),
        milli(inputs.cylinder_pressure.map(|value| value.0)),
        milli(inputs.pump_pressure.map(|value| value.0)),
        milli(inputs.oil_temperature.map(|value| value.0)),
        milli(inputs.supply.map(|value| value.0)),
        milli(inputs.lift_current.map(|value| value.0)),
        milli(inputs.lower_current.map(|value| value.0)),
    ]
    .join(",")
}

#[test]
fn an_imported_controller_answers_as_the_command_does() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let header = "time_s,lever_deg,rocker_angle_deg,cylinder_pressure_bar,pump_pressure_bar,oil_temperature_c,\
                  supply_v,measured_lift_current_a,measured_lower_current_a,hold,teach";
    let mut lines = format!("{header}\n");
    for (step, sample) in quick_move("").iter().take(8_000).enumerate() {
        let line = line(step, &sample.inputs);
        // A switch in between, and a sample that is missing in the end.
        let hold = u8::from((4_000..4_100).contains(&step));
        let _ = match step {
            7_500.. => writeln!(lines, "{:.3},92.5,,,,,,,,0,", step as f64 * 1e-3),
            _ => writeln!(lines, "{line},{hold},0"),
        };
    }
    fs::write(folder.path().join("lines.csv"), &lines).unwrap();
    fs::write(
        folder.path().join("own.toml"),
        "format = 1\n[position]\nrestart_band_mm = 0.9\n",
    )
    .unwrap();
    for calibration in [None, Some("own.toml")] {
        let options = calibration.map(|file| ["--calibration", file]);
        let options = options.as_ref().map_or(&[][..], |options| &options[..]);
        let command = answered(folder.path(), options, &lines);
        assert!(command.contains("lifting") && command.contains("fault:angle"));
        let controller = ["--controller", "--out", "own.fmu"];
        export(folder.path(), &[&controller, options].concat());
        let arguments = ["own.fmu", "lines.csv"];
        let imported = scripts().join("fmu_controller.py");
        let imported = script(python, folder.path(), &imported, &arguments);
        let answers: Vec<&str> = imported
            .lines()
            .filter(|line| !line.starts_with('['))
            .collect();
        assert_eq!(answers, command.lines().collect::<Vec<&str>>());
    }
}

/// What `hitch controller` answers to lines.
fn answered(folder: &Path, options: &[&str], lines: &str) -> String {
    let mut command = hitch();
    let command = command.arg("controller").args(options).current_dir(folder);
    let command = command.stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut input = child.stdin.take().unwrap();
    let lines = lines.to_owned();
    let writer = std::thread::spawn(move || input.write_all(lines.as_bytes()).unwrap());
    let output = child.wait_with_output().unwrap();
    writer.join().unwrap();
    assert!(output.status.success());
    String::from_utf8(output.stdout).unwrap()
}

/// What the instruments showed beyond the truth, and the lever: a line a millisecond.
fn noise(samples: &[Sample]) -> String {
    let mut text = String::from(
        "lever_deg,rocker_angle_deg,cylinder_pressure_bar,pump_pressure_bar,lift_current_a,lower_current_a\n",
    );
    let mut coils = [Coil::of(&Solenoid::default()); 2];
    let mut currents = Currents::default();
    for sample in samples {
        let told = |value: Option<i32>| f64::from(value.unwrap()) / 1e3;
        let inputs = &sample.inputs;
        let _ = writeln!(
            text,
            "{},{},{},{},{},{}",
            sample.lever_deg,
            told(inputs.rocker_angle.map(|value| value.0)) - sample.angle_deg,
            told(inputs.cylinder_pressure.map(|value| value.0)) - sample.cylinder_pressure_bar,
            told(inputs.pump_pressure.map(|value| value.0)) - sample.pump_pressure_bar,
            told(inputs.lift_current.map(|value| value.0)) - currents.lift_a,
            told(inputs.lower_current.map(|value| value.0)) - currents.lower_a,
        );
        let shares = [sample.outputs.lift_duty, sample.outputs.lower_duty]
            .map(|duty| f64::from(duty.0) * 1e-5);
        currents = Currents {
            lift_a: coils[0].step(shares[0], SUPPLY_V),
            lower_a: coils[1].step(shares[1], SUPPLY_V),
        };
    }
    text
}

#[test]
fn coupled_units_move_as_the_closed_loop_does() {
    let Some(python) = python() else { return };
    let samples = quick_move("");
    let folder = units();
    fs::write(folder.path().join("noise.csv"), noise(&samples)).unwrap();
    let arguments = [
        "plant.fmu",
        "controller.fmu",
        "noise.csv",
        "150",
        "40",
        "87.5",
        "coupled.csv",
    ];
    let coupled = scripts().join("fmu_loop.py");
    script(python, folder.path(), &coupled, &arguments);
    let coupled = table(&folder.path().join("coupled.csv"));
    assert_eq!(coupled.len(), samples.len());
    let rows = coupled.iter().zip(&samples);
    let apart_deg = rows.map(|(row, sample)| (row[0] - sample.angle_deg).abs());
    let apart_deg = apart_deg.fold(0.0, f64::max);
    println!("coupled: {apart_deg:.1e} degree from the closed loop");
    assert!(apart_deg <= 1e-6, "{apart_deg}");
    let asked_a = |sample: &Sample| f64::from(sample.outputs.lift_current.0) * 1e-3;
    let rows = coupled.iter().zip(&samples);
    assert!(
        rows.into_iter()
            .all(|(row, sample)| (row[1] - asked_a(sample)).abs() < 1e-9)
    );

    // And by the figures of the command.
    let said = succeed(
        folder.path(),
        &[
            "loop",
            "--scenario",
            "quick",
            "--load",
            "150",
            "--json",
            "-",
        ],
    );
    let document: serde_json::Value = serde_json::from_str(&said).unwrap();
    let figures = &document["moves"][0];
    assert_eq!(
        (figures["from_deg"].as_f64(), figures["to_deg"].as_f64()),
        (Some(87.5), Some(92.5))
    );
    let moved = &coupled[PICK_UP_STEPS..];
    let final_error_deg = moved.last().map(|row| (row[0] - 92.5).abs()).unwrap();
    let overshoot_deg = moved.iter().map(|row| row[0] - 92.5).fold(0.0, f64::max);
    let last_outside = moved.iter().rposition(|row| (row[0] - 92.5).abs() > 0.5);
    let time_s = last_outside.map_or(0.0, |step| (step + 1) as f64 * 1e-3);
    for (name, figure) in [
        ("final_error_deg", final_error_deg),
        ("overshoot_deg", overshoot_deg),
        ("time_s", time_s),
    ] {
        let of_command = figures[name].as_f64().unwrap();
        println!("{name}: {figure} and {of_command}");
        assert!(
            (figure - of_command).abs() <= 1e-6,
            "{name}: {figure}, {of_command}"
        );
    }
}

#[test]
fn what_an_importer_must_not_do_is_refused() {
    let Some(python) = python() else { return };
    let folder = units();
    let refusals = scripts().join("fmu_refusals.py");
    let arguments = ["plant.fmu", "controller.fmu"];
    let said = script(python, folder.path(), &refusals, &arguments);
    println!("{said}");
    assert!(said.contains("refused: all of it"), "{said}");
}

#[test]
fn the_example_of_the_documentation_couples_both() {
    let Some(python) = python() else { return };
    let folder = units();
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/fmu_loop.py");
    let arguments = ["plant.fmu", "controller.fmu"];
    let said = script(python, folder.path(), &example, &arguments);
    assert_eq!(said.matches(" deg: at ").count(), 3, "{said}");
}
