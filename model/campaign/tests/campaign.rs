//! Tests of reading campaigns: the contents of valid ones, the messages for invalid ones, and no panic on any input.

use std::fs;
use std::path::Path;

use hitch_campaign::{Bench, Campaign};
use hitch_plant::Channel;
use proptest::prelude::*;
use tempfile::TempDir;

const MANIFEST: &str = r#"format = 1
name = "lab-a"
sample_rate_hz = 50

[noise]
rocker_angle_deg = 0.05

[[run]]
file = "lift.csv"
bench = "hitch"
load_kg = 50

[[run]]
file = "flow.csv"
bench = "flow"
port_pressure_bar = 20
oil_temperature_c = 18.5
"#;

/// A log of twelve rows with an angle and a flow.
fn log() -> String {
    let row = |i: usize| format!("{:.2},1.50,0.001,{:.2},90.{i}\n", i as f64 * 0.02, i as f64);
    let rows: String = (0..12).map(row).collect();
    format!("time_s,lift_current_a,lower_current_a,flow_lpm,rocker_angle_deg\n{rows}")
}

fn folder(manifest: &[u8], lift: &[u8]) -> TempDir {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("campaign.toml"), manifest).unwrap();
    fs::write(dir.path().join("lift.csv"), lift).unwrap();
    fs::write(dir.path().join("flow.csv"), log()).unwrap();
    dir
}

/// The fault of a campaign, without the folder's name.
fn fault(manifest: &str, lift: &str) -> String {
    fault_of(folder(manifest.as_bytes(), lift.as_bytes()).path())
}

fn fault_of(dir: &Path) -> String {
    match Campaign::load(dir) {
        Ok(_) => "no fault".to_owned(),
        Err(error) => error
            .to_string()
            .replace(&format!("{}/", dir.display()), ""),
    }
}

#[test]
fn reads_what_is_there_and_fills_in_what_is_not() {
    let dir = folder(MANIFEST.as_bytes(), log().as_bytes());
    let campaign = Campaign::load(dir.path()).unwrap();
    assert_eq!(
        (campaign.name.as_str(), campaign.sample_rate_hz),
        ("lab-a", 50.0)
    );
    assert_eq!(campaign.noise.of(Channel::RockerAngle), Some(0.05));
    assert_eq!(campaign.noise.of(Channel::Flow), None);
    let [lift, flow] = &campaign.runs[..] else {
        panic!("two runs")
    };
    assert_eq!(
        (lift.bench, lift.oil_temperature_c),
        (Bench::Hitch { load_kg: 50.0 }, 40.0)
    );
    assert!(!lift.oil_temperature_known && flow.oil_temperature_known);
    assert_eq!(lift.channel(Channel::RockerAngle).unwrap()[2], 90.2);
    assert_eq!(lift.channel(Channel::PumpPressure), None);
    assert_eq!(
        (flow.bench, flow.oil_temperature_c),
        (
            Bench::Flow {
                port_pressure_bar: 20.0
            },
            18.5
        )
    );
    assert_eq!(
        flow.channel(Channel::RockerAngle),
        None,
        "a flow bench has no rocker"
    );
}

#[test]
fn a_logged_oil_temperature_is_that_of_a_run_without_a_stated_one() {
    let warming: String = log()
        .lines()
        .enumerate()
        .map(|(i, line)| match i {
            0 => format!("{line},oil_temperature_c\n"),
            1 => format!("{line},\n"),
            _ => format!("{line},{}\n", 50 + i),
        })
        .collect();
    let dir = folder(MANIFEST.as_bytes(), warming.as_bytes());
    let runs = Campaign::load(dir.path()).unwrap().runs;
    // The mean of 52 to 62; the first cell is a dropout.
    assert_eq!(runs[0].oil_temperature_c, 57.0);
    assert!(runs[0].oil_temperature_known);
    assert_eq!(runs[1].oil_temperature_c, 18.5);
}

#[test]
fn tolerates_how_other_programs_write() {
    let text = format!(
        "\u{feff}{}\n\n",
        log().replace('\n', "\r\n").replace(',', " , ")
    );
    let manifest = format!("\u{feff}{}", MANIFEST.replace("sample_rate_hz = 50\n", ""));
    let dir = folder(manifest.replace('\n', "\r\n").as_bytes(), text.as_bytes());
    let campaign = Campaign::load(dir.path()).unwrap();
    assert_eq!(campaign.runs[0].time_s.len(), 12);
    assert!((campaign.sample_rate_hz - 50.0).abs() < 1e-9);
}

#[test]
fn an_empty_cell_is_a_dropout() {
    let text = log().replace("0.10,1.50,0.001,5.00,90.5", "0.10,,0.001,5.00,");
    let dir = folder(MANIFEST.as_bytes(), text.as_bytes());
    let run = Campaign::load(dir.path()).unwrap().runs.remove(0);
    assert!(run.channel(Channel::RockerAngle).unwrap()[5].is_nan());
    assert_eq!(
        run.lift_current_a[5], 1.5,
        "a short gap of a current is bridged"
    );
}

/// Two runs of 0.38 s in one log, with a pause of 5 s between them; the log begins at 100 s.
fn long_log() -> String {
    let row = |i: usize| {
        let pause_s = if i < 20 { 0.0 } else { 5.0 };
        format!("{:.2},1.5,0,90\n", 100.0 + i as f64 * 0.02 + pause_s)
    };
    let rows: String = (0..40).map(row).collect();
    format!("time_s,lift_current_a,lower_current_a,rocker_angle_deg\n{rows}")
}

fn two_runs(first: &str, second: &str) -> String {
    let run = |times: &str| {
        format!("[[run]]\nfile = \"lift.csv\"\n{times}\nbench = \"hitch\"\nload_kg = 50\n")
    };
    format!("format = 1\n{}{}", run(first), run(second))
}

#[test]
fn a_long_log_is_cut_into_runs() {
    let manifest = two_runs("to_s = 0.38", "from_s = 5.4");
    let dir = folder(manifest.as_bytes(), long_log().as_bytes());
    let campaign = Campaign::load(dir.path()).unwrap();
    let names: Vec<&str> = campaign.runs.iter().map(|run| run.file.as_str()).collect();
    assert_eq!(names, ["lift.csv 0 to 0.38 s", "lift.csv from 5.4 s"]);
    let ends: Vec<(usize, f64, f64)> = campaign
        .runs
        .iter()
        .map(|run| {
            (
                run.time_s.len(),
                run.time_s[0],
                run.time_s[run.time_s.len() - 1],
            )
        })
        .collect();
    assert_eq!(ends, [(20, 100.0, 100.38), (20, 105.4, 105.78)]);
}

#[test]
fn parts_of_a_log_that_make_no_runs_are_refused() {
    let long_log = long_log();
    for (first, second, fault_begins) in [
        (
            "to_s = 2",
            "from_s = 1",
            "campaign.toml:8:8: \"lift.csv\" is listed twice",
        ),
        (
            "from_s = 2\nto_s = 1",
            "",
            "campaign.toml:5:8: the run ends at 1 s",
        ),
        (
            "to_s = 0.1",
            "from_s = 5.4",
            "lift.csv: contains only 6 samples within the run",
        ),
        ("to_s = 5.5", "from_s = 5.58", "lift.csv:22:1: time jumps"),
    ] {
        let said = fault(&two_runs(first, second), &long_log);
        assert!(said.starts_with(fault_begins), "{first}, {second}: {said}");
    }
}

#[test]
fn faults_of_logs_have_a_line_and_a_column() {
    let log = log();
    let cell = |good: &str, bad: &str| fault(MANIFEST, &log.replacen(good, bad, 1));
    let lost: String = (0..12)
        .map(|i| format!("{:.2},,0,1,90\n", i as f64 * 0.02))
        .collect();
    let lost = format!("{}\n{lost}", log.lines().next().unwrap());
    let unusable: String = (0..12).map(|i| format!("{i},1,0\n")).collect();
    let cases = [
        (
            cell("0.10,1.50,0.001,5.00", "0.10,1.50,0.001,wet"),
            "lift.csv:7:17: \"wet\" in column \"flow_lpm\" is not a number",
        ),
        (
            cell("0.10,1.50", "0.10,NaN"),
            "lift.csv:7:6: \"NaN\" in column \"lift_current_a\" is not a number",
        ),
        (
            cell("5.00", "-inf"),
            "lift.csv:7:17: \"-inf\" in column \"flow_lpm\" is not a number",
        ),
        (
            cell("5.00", "5e9"),
            "lift.csv:7:17: 5000000000 in column flow_lpm is out of range",
        ),
        (
            cell("0.10,1.50", "0.10,1500"),
            "lift.csv:7:6: 1500 in column lift_current_a is out of range",
        ),
        (cell("0.10,", ","), "lift.csv:7:1: \"\" is not a time"),
        (
            cell("0.10,", "0.04,"),
            "lift.csv:7:1: time goes back: 0.04 s after 0.08 s",
        ),
        (cell("0.10,", "0.08,"), "lift.csv:7:1: time stands still"),
        (cell("0.22,", "9.00,"), "lift.csv:13:1: time jumps"),
        (
            cell(",90.5", ""),
            "lift.csv:7:1: the row has 4 cells, the header has 5",
        ),
        (
            cell(",90.5", ",90.5,1"),
            "lift.csv:7:1: the row has 6 cells, the header has 5",
        ),
        (
            cell("rocker_angle_deg", "rocker_angle_rad"),
            "lift.csv:1:48: unit rad is not known, this column has to be rocker_angle_deg",
        ),
        (
            cell("flow_lpm", "flow_gpm"),
            "lift.csv:1:39: unit gpm is not known, this column has to be flow_lpm",
        ),
        (
            cell("flow_lpm", "speed"),
            "lift.csv:1:39: column \"speed\" is not known; known: time_s, ",
        ),
        (cell("flow_lpm", ""), "lift.csv:1:39: column 4 has no name"),
        (
            cell("flow_lpm", "time_s"),
            "lift.csv:1:39: column time_s is duplicated",
        ),
        (
            cell("lower_current_a", "oil_temperature_c"),
            "lift.csv:1:1: column lower_current_a is missing",
        ),
        (
            fault(MANIFEST, &log[log.find('\n').unwrap() + 1..]),
            "lift.csv:1:1: \"0.00\" is not a column name",
        ),
        (fault(MANIFEST, ""), "lift.csv: is empty"),
        (fault(MANIFEST, "\n\n"), "lift.csv: is empty"),
        (
            fault(MANIFEST, &log[..=log.find('\n').unwrap()]),
            "lift.csv: contains a header but no samples",
        ),
        (fault(MANIFEST, &log[..200]), "lift.csv:7:1: the row has"),
        (
            fault(MANIFEST, &lost),
            "lift.csv:2:6: lift_current_a has no values",
        ),
        (
            fault(
                MANIFEST,
                &format!("time_s,lift_current_a,lower_current_a\n{unusable}"),
            ),
            "lift.csv: has no usable channel",
        ),
    ];
    check(&cases);
}

#[test]
fn faults_of_the_manifest_have_a_line_and_a_column() {
    let toml = |good: &str, bad: &str| fault(&MANIFEST.replacen(good, bad, 1), &log());
    let cases = [
        (
            toml("format = 1\n", ""),
            "campaign.toml:1:1: the top level has no format",
        ),
        (
            toml("format = 1", "format = 2"),
            "campaign.toml:1:10: format 2 is not known",
        ),
        (
            toml("sample_rate_hz", "sample_rate_khz"),
            "campaign.toml:3:1: unit khz is not known, this key has to be sample_rate_hz",
        ),
        (
            toml("sample_rate_hz = 50", "sample_rate_hz = -50"),
            "campaign.toml:3:18: sample_rate_hz = -50 is out of range",
        ),
        (
            toml("rocker_angle_deg = 0.05", "rocker_angle_deg = 0"),
            "campaign.toml:6:20: rocker_angle_deg = 0 is out of range",
        ),
        (
            toml("rocker_angle_deg = 0.05", "rocker_angle_deg = \"low\""),
            "campaign.toml:6:20: rocker_angle_deg has to be a number",
        ),
        (
            toml("rocker_angle_deg", "rudder_angle_deg"),
            "campaign.toml:6:1: key \"rudder_angle_deg\" is not known",
        ),
        (
            toml("[noise]", "noise = 3\n[nois]"),
            "campaign.toml:6:2: key \"nois\" is not known in the top level; did you mean noise?",
        ),
        (
            toml("load_kg = 50\n", ""),
            "campaign.toml:8:1: [[run]] has no load_kg",
        ),
        (
            toml("load_kg = 50", "load_kg = -50"),
            "campaign.toml:11:11: load_kg = -50 is out of range",
        ),
        (
            toml("load_kg = 50", "load_lb = 50"),
            "campaign.toml:11:1: unit lb is not known, this key has to be load_kg",
        ),
        (
            toml("load_kg = 50", "load_kg = nan"),
            "campaign.toml:11:11: load_kg has to be a number",
        ),
        (
            toml("port_pressure_bar = 20", "load_kg = 20"),
            "campaign.toml:16:11: load_kg is valid only for a run on the hitch bench",
        ),
        (
            toml("\"hitch\"", "\"pitch\""),
            "campaign.toml:10:9: bench \"pitch\" is not known",
        ),
        (
            toml("\"flow.csv\"", "\"lift.csv\""),
            "campaign.toml:14:8: \"lift.csv\" is listed twice",
        ),
        (
            toml("\"flow.csv\"", "\"flaw.csv\""),
            "campaign.toml:14:8: the folder contains no file \"flaw.csv\"",
        ),
        (
            toml("\"flow.csv\"", "\"../flow.csv\""),
            "campaign.toml:14:8: the folder contains no file \"../flow.csv\"",
        ),
        (
            toml("\"flow.csv\"", "\"/no/flow.csv\""),
            "campaign.toml:14:8: file \"/no/flow.csv\" does not exist",
        ),
        (
            toml("\"flow.csv\"", "\"\""),
            "campaign.toml:14:8: \"\" is not the name of a file",
        ),
        (
            toml("18.5", "1850"),
            "campaign.toml:17:21: oil_temperature_c = 1850 is out of range",
        ),
        (toml("[[run]]", "[[run"), "campaign.toml:8:"),
        (
            fault("format = 1\n", &log()),
            "campaign.toml:1:1: the campaign has no runs",
        ),
        (
            fault("", &log()),
            "campaign.toml: the top level has no format",
        ),
    ];
    check(&cases);
}

fn check(cases: &[(String, &str)]) {
    for (fault, expected) in cases {
        assert!(
            fault.starts_with(expected),
            "expected {expected}\n     got {fault}"
        );
        assert_eq!(fault.lines().count(), 1, "{fault}");
    }
}

#[test]
fn faults_of_the_folder() {
    let dir = TempDir::new().unwrap();
    assert!(fault_of(dir.path()).contains("contains no campaign.toml"));
    assert!(fault_of(&dir.path().join("nowhere")).contains("no such folder"));
    fs::write(dir.path().join("file"), "").unwrap();
    assert!(fault_of(&dir.path().join("file")).contains("is not a folder"));
    fs::create_dir(dir.path().join("campaign.toml")).unwrap();
    assert!(fault_of(dir.path()).contains("campaign.toml: is not a file"));
}

#[test]
fn a_manifest_that_is_not_utf8_is_refused_where_it_stands() {
    let mut bytes = MANIFEST.as_bytes().to_vec();
    let byte = bytes.iter().position(|b| *b == b'\n').unwrap() + 4;
    bytes[byte] = 0xff;
    let said = fault_of(folder(&bytes, log().as_bytes()).path());
    assert!(
        said.starts_with("campaign.toml:2:4: is not UTF-8"),
        "{said}"
    );
}

#[test]
fn a_log_that_is_no_text_is_called_by_its_kind() {
    for (bytes, expected) in [
        (
            &b"MDF     4.10    "[..],
            "lift.csv: is an MDF file, not text; give its name the extension .mf4",
        ),
        (
            b"PK\x03\x04\x14\0",
            "lift.csv: is a ZIP archive or an Excel workbook, not text",
        ),
        (
            b"\x01\x02\0\x07\x08",
            "lift.csv: is a binary file, not text",
        ),
    ] {
        let said = fault_of(folder(MANIFEST.as_bytes(), bytes).path());
        assert!(said.starts_with(expected), "{said}");
    }
}

/// The number of cases of a property: few by day, many with `HITCH_THOROUGH`.
fn cases(few: u32, many: u32) -> u32 {
    match std::env::var_os("HITCH_THOROUGH") {
        Some(_) => many,
        None => few,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(256, 16_384), failure_persistence: None, ..ProptestConfig::default() })]

    /// A campaign with arbitrary changes of its bytes is either read or rejected with a message of one line.
    #[test]
    fn mutations_never_panic(
        in_log in any::<bool>(),
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 1..6),
    ) {
        let (mut manifest, mut lift) = (MANIFEST.as_bytes().to_vec(), log().into_bytes());
        let bytes = if in_log { &mut lift } else { &mut manifest };
        for (place, byte, edit) in edits {
            if bytes.is_empty() {
                break;
            }
            let at = place.index(bytes.len());
            match edit {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                2 => drop(bytes.remove(at)),
                _ => bytes.truncate(at),
            }
        }
        match Campaign::load(folder(&manifest, &lift).path()) {
            Ok(campaign) => prop_assert!(campaign.runs.iter().all(|run| run.time_s.len() >= 10)),
            Err(error) => prop_assert_eq!(error.to_string().lines().count(), 1),
        }
    }
}
