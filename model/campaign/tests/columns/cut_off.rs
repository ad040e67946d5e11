//! MDF files that are cut off or not finalised: complete records are read, and a note states their number.

use falcon_mdf::Mf4Writer;
use hitch_campaign::{Campaign, Run};
use hitch_plant::Channel;

use crate::{campaign, mdf, samples};

const COLUMNS: &str = "[columns]\nlift_current_a = \"I_lift\"\nlower_current_a = \"I_lower\"\n\
    cylinder_pressure_bar = \"p_cyl\"\n";
/// With the angle, which stands in a group of its own behind the others.
const ALL_COLUMNS: &str = "[columns]\nlift_current_a = \"I_lift\"\nlower_current_a = \"I_lower\"\n\
    cylinder_pressure_bar = \"p_cyl\"\nrocker_angle_deg = \"phi\"\n";
/// Size of a record of time and three channels, and of the head of a block.
const RECORD: usize = 4 * 8;
const HEAD: usize = 24;

/// A log with one group, whose records are its last block.
fn one_group() -> Vec<u8> {
    let column = |index: usize| samples().iter().map(|row| row[index]).collect::<Vec<f64>>();
    let mut writer = Mf4Writer::new();
    let group = writer.add_group(&column(0)).unwrap();
    group.add_channel("I_lift", "A", &column(1)).unwrap();
    group.add_channel("I_lower", "A", &column(2)).unwrap();
    group.add_channel("p_cyl", "bar", &column(3)).unwrap();
    let mut bytes = Vec::new();
    writer.write(&mut bytes).unwrap();
    bytes
}

fn places(bytes: &[u8], kind: &[u8; 4]) -> Vec<usize> {
    let blocks = bytes.windows(4).enumerate();
    let blocks = blocks.filter(|(_, found)| found == kind);
    blocks.map(|(at, _)| at).collect()
}

/// The run of a log with the note about its end, or the error message.
fn read(bytes: &[u8], columns: &str) -> Result<(Run, Option<String>), String> {
    let dir = campaign("a.mf4", bytes, columns);
    let manifest = std::fs::read_to_string(dir.path().join("campaign.toml")).unwrap();
    let model = hitch_model_file::nominal();
    let read = Campaign::uncut(dir.path(), &manifest, model.linkage());
    let (mut campaign, mut notes) = read.map_err(|error| error.to_string())?;
    Ok((campaign.runs.remove(0), notes.remove(0).cut_off))
}

fn said(rows: usize) -> Option<String> {
    let lasts_s = 0.01 * (rows - 1) as f64;
    Some(format!(
        "the file is cut off: {rows} samples, {lasts_s:.2} s, are whole"
    ))
}

/// As loggers leave a file that was not closed: its name, the counters, and the length of the last data.
fn unfinished(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes[..8].copy_from_slice(b"UnFinMF ");
    bytes[60..62].copy_from_slice(&0b101_u16.to_le_bytes());
    let last = *places(&bytes, b"##DT").last().unwrap();
    bytes[last + 8..last + 16].copy_from_slice(&(HEAD as u64).to_le_bytes());
    for at in places(&bytes, b"##CG") {
        bytes[at + 80..at + 88].fill(0);
    }
    bytes
}

#[test]
fn of_a_recording_that_is_cut_off_or_unfinished_the_whole_records_are_read() {
    let whole = one_group();
    assert_eq!(read(&whole, COLUMNS).unwrap().1, None);
    let data = places(&whole, b"##DT")[0] + HEAD;
    assert_eq!(whole.len(), data + 200 * RECORD);
    for length in (data + 10 * RECORD..whole.len()).step_by(101) {
        let rows = (length - data) / RECORD;
        for bytes in [whole.clone(), unfinished(whole.clone())] {
            let (run, note) = read(&bytes[..length], COLUMNS).unwrap();
            let expected = samples()[..rows].to_vec();
            assert_eq!(run.time_s.len(), rows);
            for (row, expected) in expected.iter().enumerate() {
                let pressure = run.channel(Channel::CylinderPressure).unwrap()[row];
                let got = [run.time_s[row], run.lift_current_a[row], pressure];
                assert_eq!(got, [expected[0], expected[1], expected[3]]);
            }
            assert_eq!(note, said(rows));
        }
    }
    let (run, note) = read(&unfinished(whole), COLUMNS).unwrap();
    assert_eq!((run.time_s.len(), note), (200, said(200)));
}

#[test]
fn rows_end_with_the_channel_that_is_cut_off_and_a_lost_one_is_named() {
    let whole = mdf(None);
    let [first, second] = places(&whole, b"##DT")[..] else {
        panic!("two groups have two blocks of data");
    };
    // 100 records of an angle every 5 ms, and a half one.
    let (run, note) = read(&whole[..second + HEAD + 100 * 16 + 8], ALL_COLUMNS).unwrap();
    assert_eq!((run.time_s.len(), note), (50, said(50)));
    assert!(
        run.channel(Channel::RockerAngle)
            .unwrap()
            .iter()
            .all(|angle| angle.is_finite())
    );
    // Without the data of the angle, and without its description.
    let got = read(&whole[..second], ALL_COLUMNS).unwrap_err();
    assert!(
        got.contains("channel \"phi\": the file is cut off before its samples"),
        "{got}"
    );
    assert_eq!(read(&whole[..second], COLUMNS).unwrap().1, said(200));
    let description = first + HEAD + 200 * RECORD;
    let got = read(&whole[..description], ALL_COLUMNS).unwrap_err();
    assert!(got.contains("channel \"phi\" does not exist"), "{got}");
    let (run, note) = read(&whole[..description + 40], COLUMNS).unwrap();
    assert_eq!((run.time_s.len(), note), (200, said(200)));
    // A description of channels that is not whole has no names.
    let got = read(&whole[..first - 40], COLUMNS).unwrap_err();
    assert!(
        got.contains("cut off before the description of its channels"),
        "{got}"
    );
}
