//! Tests of tables of frames, as CANedge, SavvyCAN and python-can write them.

use hitch_campaign::{Campaign, Run};

use crate::logs::folder;

const DBC: &str = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: Bench\n\nBO_ 2566866304 Valves: 3 Bench\n \
    SG_ Lift : 0|8@1+ (0.01,0) [0|4] \"A\" X\n SG_ Lower : 8|8@1+ (0.01,0) [0|4] \"A\" X\n \
    SG_ Angle : 16|8@1+ (0.5,0) [0|180] \"deg\" X\n\n";
const MANIFEST: &str = "format = 1\n[can]\ndbc = \"a.dbc\"\n[can.signals]\nlift_current_a = \"Valves.Lift\"\n\
    lower_current_a = \"Valves.Lower\"\nrocker_angle_deg = \"Valves.Angle\"\n\
    [[run]]\nfile = \"a.csv\"\nbench = \"hitch\"\nload_kg = 150\n";

/// A header, and a row for each of 20 frames with the bytes 01 02 FF, which `of_time` writes for its time in ms.
fn table(header: &str, of_time: impl Fn(u32) -> String) -> String {
    let rows: String = (0..20).map(|index| of_time(1_500 + 20 * index)).collect();
    format!("{header}\n{rows}")
}

fn read(text: &str) -> Result<Run, String> {
    let dir = folder(&[("campaign.toml", MANIFEST), ("a.dbc", DBC), ("a.csv", text)]);
    let campaign = Campaign::load(dir.path()).map_err(|error| {
        let said = error.to_string();
        said.replace(&format!("{}/", dir.path().display()), "")
    });
    campaign.map(|mut campaign| campaign.runs.remove(0))
}

#[test]
fn tables_of_three_loggers_have_the_same_frames() {
    let edge = table(
        "TimestampEpoch;BusChannel;ID;IDE;DLC;DataLength;Dir;EDL;BRS;DataBytes",
        |ms| {
            format!(
                "{}.{:03};1;18FF4580;1;3;3;0;0;0;0102FF\n",
                ms / 1000,
                ms % 1000
            )
        },
    );
    let savvy = table(
        "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8",
        |ms| format!("{ms}000,18FF4580,true,Rx,0,3,01,02,FF,\n"),
    );
    let python = table(
        "timestamp,arbitration_id,extended,remote,error,dlc,data",
        |ms| {
            let time = format!("{}.{:03}", ms / 1000, ms % 1000);
            format!("{time},0x18ff4580,1,0,0,3,AQL/\n{time},0x100,0,1,0,0,\n")
        },
    );
    for text in [&edge, &savvy, &python] {
        let run = read(text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(run.lift_current_a, [0.01; 20]);
        assert_eq!(run.lower_current_a, [0.02; 20]);
        assert_eq!(run.channels[3], Some(vec![127.5; 20]));
        let is_right = |(index, time_s): (usize, &f64)| (time_s - 0.02 * index as f64).abs() < 1e-9;
        assert!(
            run.time_s.iter().enumerate().all(is_right),
            "{:?}",
            run.time_s
        );
    }
    for (bad, what) in [
        (
            edge.replacen("0102FF", "0102F", 1),
            "is not the data of a frame",
        ),
        (edge.replacen("1.500;", "x;", 1), "is not a time"),
        (
            edge.replacen("18FF4580", "FFFFFFFF", 1),
            "is not an identifier",
        ),
    ] {
        let said = read(&bad).unwrap_err();
        assert!(
            said.starts_with("a.csv:2:") && said.contains(what),
            "{said}"
        );
    }
}
