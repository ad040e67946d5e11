//! Faults of a log or its settings are reported with their position.

use super::logs::*;

#[test]
fn what_is_wrong_with_a_line_is_said_with_its_place() {
    let good = candump(12);
    let with = |line: &str| fault_of_log(&format!("{good}{line}\n"));
    let cases = [
        (
            "1700000000.5 can0 123#00",
            "a.log:25:1: \"1700000000.5\" is not a time in parentheses",
        ),
        (
            "(noon) can0 123#00",
            "a.log:25:1: \"(noon)\" is not a time in seconds",
        ),
        (
            "(1700000001.0)",
            "a.log:25:15: the line ends before its bus",
        ),
        (
            "(1700000001.0) can0",
            "a.log:25:20: the line ends before its frame",
        ),
        (
            "(1700000001.0) can0 123 [2] 00 11",
            "a.log:25:21: \"123\" is not a frame",
        ),
        (
            "(1700000001.0) can0 12#00",
            "a.log:25:21: \"12#00\" has no identifier",
        ),
        (
            "(1700000001.0) can0 FFF#00",
            "a.log:25:21: \"FFF#00\" has more than 11 bits",
        ),
        (
            "(1700000001.0) can0 18FF4580#0x11",
            "a.log:25:30: \"18FF4580#0x11\" has bad data",
        ),
        (
            "(1700000001.0) can0 18FF4580#001",
            "a.log:25:32: \"18FF4580#001\" has bad data",
        ),
        (
            "(1700000001.0) can0 18FF4580#001122334455667788",
            "a.log:25:46: \"18FF4580#001122334455667788\" has too many data bytes",
        ),
        (
            "(1700000001.0) can0 18FF4580##",
            "a.log:25:21: \"18FF4580##\" has no flags",
        ),
        (
            "(1700000001.0) can0 18FF4580#00 X",
            "a.log:25:33: \"X\" follows the frame",
        ),
        (
            "(1700000000.3) can0 18FF4580#00",
            "a.log:25:1: the frame has 1 bytes, too few for HitchMotion.SampleTime",
        ),
        (
            "(1700000000.3) can0 18FF4580#DC82007D48710000",
            "a.log:25:1: time goes back",
        ),
        (
            "(1700000009.3) can0 18FF4580#DC82007D48710000",
            "a.log:25:1: HitchMotion.SampleTime jumps",
        ),
    ];
    for (line, expected) in cases {
        let said = with(line);
        assert!(said.starts_with(expected), "{line}\n{said}");
    }
}

#[test]
fn what_is_wrong_with_a_line_of_vector_s_is_said_with_its_place() {
    let manifest = MANIFEST.replace("a.log", "a.asc");
    let with = |line: &str| {
        let log = format!("base hex timestamps absolute\n{line}\n");
        fault(&[("campaign.toml", &manifest), ("a.asc", &log)])
    };
    let cases = [
        ("base oct", "a.asc:2:6: \"oct\" is not a base"),
        (
            "base hex timestamps some",
            "a.asc:2:21: \"some\" is not a kind of time stamp",
        ),
        ("soon 1 123 Rx d 1 00", "a.asc:2:1: \"soon\" is not a time"),
        (
            " 0.5 1 EngineData Rx d 1 00",
            "a.asc:2:8: \"EngineData\" is not an identifier",
        ),
        (
            " 0.5 1 800 Rx d 1 00",
            "a.asc:2:8: \"800\" is not an identifier",
        ),
        (
            " 0.5 1 123 Up d 1 00",
            "a.asc:2:12: \"Up\" is not a direction",
        ),
        (
            " 0.5 1 123 Rx q 1 00",
            "a.asc:2:15: \"q\" is not a kind of frame",
        ),
        (
            " 0.5 1 18FF4580x Rx d 2 00",
            "a.asc:2:27: the line ends before its last byte",
        ),
        (
            " 0.5 1 18FF4580x Rx d 1 +1",
            "a.asc:2:25: \"+1\" is not a number of the required range",
        ),
        (
            " 0.5 CANFD 1 Rx 18FF4580x 1 0 8 99 00",
            "a.asc:2:33: \"99\" is not a number of the required range",
        ),
        (
            "",
            "a.asc: contains no HitchMotion.LiftCurrent, which is assigned to lift_current_a; the ECU sends it",
        ),
    ];
    for (line, expected) in cases {
        let said = with(line);
        assert!(said.starts_with(expected), "{line}\n{said}");
    }
}

#[test]
fn what_is_wrong_with_the_settings_is_said_with_its_place() {
    let log = candump(12);
    let with = |can: &str, dbc: &str| {
        let manifest = format!("{MANIFEST}{can}");
        fault(&[
            ("campaign.toml", &manifest),
            ("a.log", &log),
            ("rig.dbc", dbc),
        ])
    };
    let signals = "[can]\ndbc = \"rig.dbc\"\n[can.signals]\nlift_current_a = \"M.S\"\n";
    let dbc = |signal: &str| {
        format!("VERSION \"\"\nBU_:\nBO_ 1 M: 8 Vector__XXX\n SG_ S : {signal} Vector__XXX\n")
    };
    let good = dbc("0|8@1+ (1,0) [0|1] \"A\"");
    let cases = [
        (
            "[can]\ndbc = \"no.dbc\"\n",
            &good,
            "campaign.toml:7:7: the folder contains no file \"no.dbc\"",
        ),
        (
            "[can]\ndbc = \"rig.dbc\"\n",
            &good,
            "campaign.toml:6:1: [can] has a dbc but no signals",
        ),
        (
            "[can]\nsource = 300\n",
            &good,
            "campaign.toml:7:10: source = 300 is out of range",
        ),
        (
            "[can]\nclock = \"Noon\"\n[can.signals]\n",
            &good,
            "campaign.toml:7:9: no message of an assigned signal has a signal \"Noon\"",
        ),
        (
            "[can.signals]\nlift = \"M.S\"\n",
            &good,
            "campaign.toml:7:1: key \"lift\" is not known",
        ),
        (
            "[can.signals]\nflow_lpm = \"Flow\"\n",
            &good,
            "campaign.toml:7:12: \"Flow\" is not a signal",
        ),
        (
            "[can.signals]\nflow_lpm = \"HitchMotio.X\"\n",
            &good,
            "campaign.toml:7:12: the DBC has no message \"HitchMotio\"; did you mean HitchMotion?",
        ),
        (
            "[can.signals]\nflow_lpm = \"HitchMotion.RockerAngle\"\n",
            &good,
            "campaign.toml:7:12: signal HitchMotion.RockerAngle is in \"deg\"",
        ),
        (
            signals,
            &dbc("0|8@1+ (1,0) [0|1] \"\""),
            "campaign.toml:9:18: signal M.S has no unit",
        ),
        (
            signals,
            &dbc("0|0@1+ (1,0) [0|1] \"A\""),
            "campaign.toml:9:18: signal M.S has bits beyond the length of a frame",
        ),
        (
            signals,
            &"VERSION \"\"\nBO_ x\n".to_owned(),
            "rig.dbc:2:5: this is not DBC",
        ),
        (
            signals,
            &good,
            "a.log: contains no M.S, which is assigned to lift_current_a; log the bus",
        ),
    ];
    for (can, dbc, expected) in cases {
        let said = with(can, dbc);
        assert!(
            said.starts_with(expected),
            "{can}\n{said}\nexpected {expected}"
        );
    }
}
