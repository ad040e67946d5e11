//! `hitch import`: the files of any logger become a campaign that reads to the runs of this project's own format.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use hitch_campaign::{Campaign, Run};
use hitch_plant::{Channel, Linkage};
use host_tests::german_log::german_log;
use host_tests::program::run;
use host_tests::python::{self, installed, scripts};
use host_tests::refusal::refused;
use tempfile::TempDir;

/// Seconds of a log with two motions of 10 s each and long rests between them.
const LASTS_S: f64 = 80.0;

/// Time, lift current, lowering current, pressure, angle.
fn samples() -> Vec<[f64; 5]> {
    let sample = |i: u32| {
        let time_s = f64::from(i) * 0.02;
        let up = (10.0..20.0).contains(&time_s);
        let down = (50.0..60.0).contains(&time_s);
        let travel_s = (time_s - 10.0).clamp(0.0, 10.0) - (time_s - 50.0).clamp(0.0, 10.0);
        let lift_a = if up { 1.5 } else { 0.0 };
        let lower_a = if down { 1.6 } else { 0.0 };
        [
            time_s,
            lift_a,
            lower_a,
            40.0 + travel_s,
            60.0 + 4.0 * travel_s,
        ]
    };
    (0..=(LASTS_S / 0.02) as u32).map(sample).collect()
}

pub fn own() -> String {
    let row = |[t, a, b, p, w]: [f64; 5]| format!("{t:.2},{a:.4},{b:.4},{p:.4},{w:.4}\n");
    let rows: String = samples().into_iter().map(row).collect();
    format!("time_s,lift_current_a,lower_current_a,cylinder_pressure_bar,rocker_angle_deg\n{rows}")
}

fn german() -> Vec<u8> {
    let row = |[t, a, b, p, w]: [f64; 5]| {
        let row = format!("{t:.2};x;{:.1};{:.1};{p:.4};{w:.4}\r\n", a * 1e3, b * 1e3);
        row.replace('.', ",")
    };
    let rows: String = samples().into_iter().map(row).collect();
    let head = "Prüfstand;;;;;\r\nZeit;Bemerkung;Ventil Heben Strom;Ventil Senken Strom;Druck Zylinder;Winkel Hubwelle\r\ns;;mA;mA;bar;°\r\n";
    let text = format!("{head}{rows}");
    text.chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap())
        .collect()
}

fn english() -> String {
    let row = |[t, a, b, p, w]: [f64; 5]| {
        let psi = p * 1e5 / 6_894.757_293_168;
        let (minute, second) = ((t / 60.0).floor(), t % 60.0);
        let w = w.to_radians();
        format!(
            "2026-11-21T10:{minute:02}:{second:06.3}Z,{:.1},{:.1},{psi:.4},{w:.6}\n",
            a * 1e3,
            b * 1e3
        )
    };
    let rows: String = samples().into_iter().map(row).collect();
    format!("Timestamp,LiftCurrent,LowerCurrent,Cylinder Pressure [psi],Rocker Angle\n{rows}")
}

pub fn imported(dir: &Path, arguments: &str) -> (String, Vec<Run>) {
    let arguments: Vec<&str> = arguments.split(' ').collect();
    let Output {
        status,
        stdout,
        stderr,
    } = run(dir, &arguments);
    let said = String::from_utf8(stdout).unwrap();
    assert!(
        status.success(),
        "{said}{}",
        String::from_utf8_lossy(&stderr)
    );
    let campaign = Campaign::load(&dir.join("c")).unwrap_or_else(|error| panic!("{error}"));
    (said, campaign.runs)
}

pub fn assert_same(case: &str, runs: &[Run], expected: &[Run]) {
    assert_eq!(runs.len(), expected.len(), "{case}");
    for (run, expected) in runs.iter().zip(expected) {
        assert_eq!(run.time_s.len(), expected.time_s.len(), "{case}");
        let near = |got: &[f64], expected: &[f64], rounding: f64| {
            let same = got
                .iter()
                .zip(expected)
                .all(|(got, expected)| (got - expected).abs() <= rounding);
            assert!(same && got.len() == expected.len(), "{case}");
        };
        near(&run.time_s, &expected.time_s, 1e-3);
        near(&run.lift_current_a, &expected.lift_current_a, 1e-4);
        near(&run.lower_current_a, &expected.lower_current_a, 1e-4);
        for channel in [Channel::CylinderPressure, Channel::RockerAngle] {
            near(
                run.channel(channel).unwrap(),
                expected.channel(channel).unwrap(),
                1e-3,
            );
        }
    }
}

// REQ-INPUT-03
#[test]
fn logs_of_any_dialect_read_to_the_same_runs() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("own.csv"), own()).unwrap();
    let (_, expected) = imported(dir.path(), "import own.csv --out c --load 150");
    assert_eq!(
        expected.len(),
        2,
        "two motions with a long rest between them"
    );
    for (file, bytes, said) in [
        ("german.csv", german(), "Ventil Heben Strom:mA"),
        ("english.csv", english().into_bytes(), "radians"),
    ] {
        let dir = TempDir::new().unwrap();
        fs::write(dir.path().join(file), bytes).unwrap();
        let (text, runs) = imported(dir.path(), &format!("import {file} --out c --load 150"));
        assert!(
            text.contains(said) && text.contains("next: hitch compare c"),
            "{text}"
        );
        assert_same(file, &runs, &expected);
        assert_eq!(
            fs::read_dir(dir.path().join("c")).unwrap().count(),
            1,
            "read in place"
        );
    }
}

/// Currents in mA in one message, angle in hundredths of a degree and pressure in kPa in another, and frames of a third.
fn candump() -> String {
    let frame = |[t, a, b, p, w]: [f64; 5]| {
        let counts = [a * 1e3, b * 1e3, p * 1e2, w * 1e2].map(|value| value.round() as u16);
        let hex = |value: u16| format!("{:04X}", value.swap_bytes());
        let [a, b, p, w] = counts.map(hex);
        format!("({t:.6}) can0 101#{a}{b}\n({t:.6}) can0 102#{w}{p}\n({t:.6}) can0 7FF#123\n")
    };
    samples().into_iter().map(frame).collect()
}

/// The description of the bus, in Windows-1252, as most tools write it.
pub fn dbc() -> Vec<u8> {
    let dbc = "VERSION \"\"\nBU_: Rig\n\
        BO_ 257 Valves: 4 Rig\n SG_ Y1 : 0|16@1+ (1,0) [0|0] \"mA\" Rig\n SG_ Y2 : 16|16@1+ (1,0) [0|0] \"mA\" Rig\n\
        BO_ 258 Hitch: 4 Rig\n SG_ Winkel : 0|16@1+ (0.01,0) [0|0] \"\u{b0}\" Rig\n \
        SG_ ZylDruck : 16|16@1+ (1,0) [0|0] \"kPa\" Rig\n\
        BO_ 259 Wanted: 4 Rig\n SG_ LiftCurrent : 0|16@1+ (1,0) [0|0] \"mA\" Rig\n\
        CM_ SG_ 257 Y1 \"Magnetstrom Heben\";\nCM_ SG_ 257 Y2 \"Magnetstrom Senken\";\n";
    dbc.chars()
        .map(|c| u8::try_from(u32::from(c)).unwrap())
        .collect()
}

// REQ-INPUT-03
#[test]
fn signals_of_a_bus_are_recognised_by_names_comments_and_units() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("own.csv"), own()).unwrap();
    let (_, expected) = imported(dir.path(), "import own.csv --out c --load 150");
    fs::remove_dir_all(dir.path().join("c")).unwrap();
    fs::write(dir.path().join("bus.log"), candump()).unwrap();
    fs::write(dir.path().join("rig.dbc"), dbc()).unwrap();
    let (text, runs) = imported(dir.path(), "import bus.log rig.dbc --out c --load 150");
    for said in [
        "Valves.Y1",
        "by its comment",
        "Hitch.Winkel",
        "4001 frames of messages that it does not define",
    ] {
        assert!(text.contains(said), "{said}\n{text}");
    }
    assert_same("bus", &runs, &expected);
    assert!(
        runs[0].file.starts_with("bus.log 8.5 to "),
        "{}",
        runs[0].file
    );
    refused(
        dir.path(),
        &[
            "import", "own.csv", "rig.dbc", "--out", "d", "--load", "150",
        ],
        "describes a bus, but no log of a bus",
    );
}

#[test]
fn travel_of_the_cylinder_is_an_angle_by_the_linkage_of_the_model() {
    let dir = TempDir::new().unwrap();
    let row = |[t, a, b, p, w]: [f64; 5]| format!("{t:.2},{a},{b},{p},{:.3}\n", 10.0 + (w - 60.0));
    let rows: String = samples().into_iter().map(row).collect();
    let log = format!(
        "time [s],lift current [A],lower current [A],cylinder pressure [bar],stroke [mm]\n{rows}"
    );
    fs::write(dir.path().join("log.csv"), log).unwrap();
    let nominal = hitch_model_file::to_toml(&hitch_model_file::nominal());
    let arm = nominal
        .lines()
        .find(|line| line.starts_with("rocker_arm"))
        .unwrap();
    let (key, value) = arm.split_once(" = ").unwrap();
    let value: f64 = value.split_whitespace().next().unwrap().parse().unwrap();
    let other = nominal.replace(arm, &format!("{key} = {}", value * 1.05));
    fs::write(dir.path().join("other.toml"), other).unwrap();
    let (_, runs) = imported(dir.path(), "import log.csv --out c --load 150");
    fs::remove_dir_all(dir.path().join("c")).unwrap();
    let arguments = "import log.csv --out c --load 150 --model other.toml";
    let (text, _) = imported(dir.path(), arguments);
    assert!(
        text.contains("next: hitch compare c --model other.toml"),
        "{text}"
    );
    let model = hitch_model_file::named(dir.path().join("other.toml").to_str().unwrap()).unwrap();
    let others = Campaign::load_with(&dir.path().join("c"), model.linkage()).unwrap();
    let angle_deg = |run: &Run| run.channel(Channel::RockerAngle).unwrap()[0];
    let expected = |linkage: &Linkage| linkage.at(0.01).rocker_angle_rad.to_degrees();
    let [own_deg, other_deg] = [&runs[0], &others.runs[0]].map(angle_deg);
    assert!((own_deg - expected(hitch_model_file::nominal().linkage())).abs() < 1e-9);
    assert!((other_deg - expected(model.linkage())).abs() < 1e-9);
    assert!((own_deg - other_deg).abs() > 0.1, "{own_deg} {other_deg}");
}

// REQ-INPUT-03
#[test]
fn mdf_of_another_program_reads_to_the_same_runs() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let Some(python) = installed("asammdf.txt", folder) else {
        return;
    };
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("own.csv"), own()).unwrap();
    let (_, expected) = imported(dir.path(), "import own.csv --out c --load 150");
    let mut command = Command::new(python);
    let command = command
        .arg(scripts().join("write_mdf.py"))
        .arg(dir.path().join("own.csv"));
    let written = python::run(command).unwrap_or_else(|reason| panic!("{reason}"));
    assert_eq!(written.lines().count(), 7, "{written}");
    for file in written.lines() {
        fs::remove_dir_all(dir.path().join("c")).unwrap();
        let (text, runs) = imported(dir.path(), &format!("import {file} --out c --load 150"));
        assert!(text.contains("LiftCurrent:mA"), "{text}");
        assert_same(file, &runs, &expected);
    }
}

#[test]
fn what_cannot_be_told_is_asked_for() {
    let dir = TempDir::new().unwrap();
    let odd = own()
        .replacen("lift_current_a", "A1", 1)
        .replacen("lower_current_a", "A2", 1);
    fs::write(dir.path().join("odd.csv"), odd).unwrap();
    fs::write(dir.path().join("own.csv"), own()).unwrap();
    fs::write(dir.path().join("log.blf"), b"LOGG\0\0\0").unwrap();
    fs::write(dir.path().join("log.trc"), ";$FILEVERSION=2.1\n").unwrap();
    fs::write(dir.path().join("text.csv"), "nothing\nhere\n").unwrap();
    for (arguments, expected) in [
        (
            "import odd.csv --out c --load 150",
            "no column was recognised as lift_current_a",
        ),
        ("import own.csv --out c", "give it with --load KG"),
        (
            "import odd.csv --out c --load 150 --map A1",
            "write it as --map CHANNEL",
        ),
        (
            "import odd.csv --out c --load 150 --map current=A1",
            "channel \"current\" is not known",
        ),
        (
            "import gone.csv --out c --load 150",
            "gone.csv: no such file",
        ),
        (
            "import log.blf --out c --load 150",
            "log.blf: ends within its header",
        ),
        (
            "import log.trc --out c --load 150",
            "log.trc: is a PCAN trace of a CAN bus (TRC)",
        ),
        (
            "import text.csv --out c --load 150",
            "text.csv: is not a table",
        ),
        ("import own.csv --out c --bench flow", "--port-pressure BAR"),
    ] {
        refused(
            dir.path(),
            &arguments.split(' ').collect::<Vec<_>>(),
            expected,
        );
    }
    let maps =
        "import odd.csv --out c --load 150 --map lift_current_a=A1:A --map lower_current_a=A2:A";
    let (text, runs) = imported(dir.path(), maps);
    assert!(text.contains("given by --map") && runs.len() == 2, "{text}");
    refused(
        dir.path(),
        &maps.split(' ').collect::<Vec<_>>(),
        "exists already",
    );
}

/// A valve that is off shows a few milliampere. They are not ampere where the other current states the same unit and has more.
#[test]
fn an_idle_valve_keeps_the_unit_that_the_log_states() {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("log.csv"), german_log()).unwrap();
    let arguments = ["import", "log.csv", "--out", "c", "--load", "150", "--yes"];
    let output = run(dir.path(), &arguments);
    let said = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{output:?}");
    assert!(said.contains("Ventil Heben Strom:mA"), "{said}");
    let campaign = Campaign::load(&dir.path().join("c")).unwrap();
    let lift_a = &campaign.runs[0].lift_current_a;
    assert!(lift_a.iter().all(|&lift_a| lift_a < 0.05), "{said}");
}
