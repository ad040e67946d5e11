//! Tests of what a DBC may leave out or say in other words: groups of J1939, and multiplexors.

use std::fmt::Write as _;
use std::fs;

use hitch_campaign::Campaign;
use hitch_campaign::survey::bus_signals;

use crate::logs::folder;

const MESSAGE: &str = " Valves: 8 Bench\n SG_ LiftCurrent : 0|16@1+ (0.001,0) [0|4] \"A\" X\n \
                       SG_ LowerCurrent : 16|16@1+ (0.001,0) [0|4] \"A\" X\n \
                       SG_ RockerAngle : 32|16@1+ (0.01,0) [0|180] \"deg\" X\n\n";
const SIGNALS: &str = "lift_current_a = \"Valves.LiftCurrent\"\nlower_current_a = \"Valves.LowerCurrent\"\n\
                       rocker_angle_deg = \"Valves.RockerAngle\"\n";

fn dbc(messages: &str) -> String {
    format!("VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: Bench\n\n{messages}")
}

/// A log with this identifier: lift 1.5 A, 90 degrees; byte 7 counts.
fn log(id: &str) -> String {
    (0..40).fold(String::new(), |mut text, index| {
        let time_s = 1.0 + 0.02 * f64::from(index);
        let page = index % 4;
        let _ = writeln!(text, "({time_s:.6}) can0 {id}#DC0500002823{page:04X}");
        text
    })
}

fn manifest(settings: &str) -> String {
    format!(
        "format = 1\n[can]\ndbc = \"a.dbc\"\n{settings}[can.signals]\n{SIGNALS}\
         [[run]]\nfile = \"a.log\"\nbench = \"hitch\"\nload_kg = 150\n"
    )
}

/// The manifest, the description and the log of a campaign by groups of J1939.
pub fn described() -> [String; 3] {
    let message = dbc(&format!("BO_ {}{MESSAGE}", 0x98FF_45FE_u32));
    [
        manifest("identifiers = \"j1939\"\n"),
        message,
        log("0CFF4521"),
    ]
}

#[test]
fn a_group_is_heard_from_another_address_and_said_to_be_one() {
    // 0x98FF45FE: group 0xFF45 with priority 6 from the null address, as DBCs of J1939 have it.
    let message = dbc(&format!("BO_ {}{MESSAGE}", 0x98FF_45FE_u32));
    let dir = folder(&[("a.dbc", &message), ("a.log", &log("0CFF4521"))]);
    let (file, dbc_file) = (dir.path().join("a.log"), dir.path().join("a.dbc"));
    let found = bus_signals(&file, &dbc_file).unwrap();
    assert!(found.is_j1939 && found.columns.len() == 3);

    fs::write(dir.path().join("campaign.toml"), manifest("")).unwrap();
    assert!(Campaign::load(dir.path()).is_err(), "exact by default");
    let text = manifest("identifiers = \"j1939\"\n");
    fs::write(dir.path().join("campaign.toml"), text).unwrap();
    let campaign = Campaign::load(dir.path()).unwrap();
    assert_eq!(campaign.runs[0].lift_current_a, [1.5; 40]);

    fs::write(&file, log("18FF45FE")).unwrap();
    assert!(!bus_signals(&file, &dbc_file).unwrap().is_j1939, "exact");
    fs::write(&file, log("18FF4621")).unwrap();
    assert!(bus_signals(&file, &dbc_file).is_err(), "another group");
}

#[test]
fn identifiers_that_differ_only_in_the_address_are_no_groups() {
    let other = MESSAGE.replace("Valves", "Others");
    let (one, two) = (0x98FF_4501_u32, 0x98FF_4502_u32);
    let text = dbc(&format!("BO_ {one}{MESSAGE}BO_ {two}{other}"));
    let dir = folder(&[("a.dbc", &text), ("a.log", &log("18FF4501"))]);
    let found = bus_signals(&dir.path().join("a.log"), &dir.path().join("a.dbc"));
    assert!(!found.unwrap().is_j1939);
}

#[test]
fn a_multiplexor_selects_by_ranges_and_by_another_one() {
    let selected = |ranges: &str| {
        let message = MESSAGE
            .replace("LiftCurrent :", "LiftCurrent m0 :")
            .replace("\n\n", "\n SG_ Page M : 56|8@1+ (1,0) [0|3] \"\" X\n SG_ Part m1M : 48|8@1+ (1,0) [0|3] \"\" X\n\n");
        let text = dbc(&format!("BO_ 256{message}{ranges}"));
        let files = [
            ("campaign.toml", &*manifest("")),
            ("a.dbc", &text),
            ("a.log", &log("100")),
        ];
        let dir = folder(&files);
        Campaign::load(dir.path()).map(|campaign| campaign.runs[0].time_s.len())
    };
    assert_eq!(selected("").unwrap(), 10);
    assert_eq!(
        selected("SG_MUL_VAL_ 256 LiftCurrent Page 0-0, 2-3;\n").unwrap(),
        30
    );
    let chain = "SG_MUL_VAL_ 256 LiftCurrent Part 0-0;\nSG_MUL_VAL_ 256 Part Page 1-3;\n";
    assert_eq!(selected(chain).unwrap(), 30);
    let circle = "SG_MUL_VAL_ 256 LiftCurrent Part 0-0;\nSG_MUL_VAL_ 256 Part Part 0-0;\n";
    assert!(
        selected(circle)
            .unwrap_err()
            .to_string()
            .contains("select each other")
    );
}
