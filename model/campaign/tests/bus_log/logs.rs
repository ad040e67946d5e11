//! Synthetic logs of a CAN bus, and the runs read from them.

use std::fmt::Write as _;
use std::fs;

use hitch_campaign::{Campaign, Run};
use tempfile::TempDir;

/// Identifiers of the ECU's messages from address 128, and from 129.
pub const MOTION: &str = "18FF4580";
pub const PRESSURES: &str = "18FF4680";
pub const MOTION_OF_ANOTHER: &str = "18FF4581";

pub const MANIFEST: &str =
    "format = 1\n[[run]]\nfile = \"a.log\"\nbench = \"hitch\"\nload_kg = 150\n";

/// Sample `index` of a log at 50 Hz: data of both messages. Lift 1.5 A, lowering 0 A, 90 degrees plus 0.01 per sample;
/// 20 bar and 35 bar.
pub fn sample(index: u16) -> [String; 2] {
    let time_ms = (63_900 + 20 * u32::from(index)) % 64_000;
    let hex = |words: [u16; 4]| {
        let bytes = words.map(u16::to_le_bytes);
        bytes
            .as_flattened()
            .iter()
            .fold(String::new(), |mut text, byte| {
                let _ = write!(text, "{byte:02X}");
                text
            })
    };
    let time = time_ms as u16;
    [
        hex([33_500, 32_000, 29_000 + index, time]),
        hex([7_000, 8_500, 0xFFFF, time]),
    ]
}

/// A candump log with a jitter of its time stamps of 8 ms.
pub fn candump(samples: u16) -> String {
    let mut text = String::new();
    for index in 0..samples {
        let late_s = f64::from(index % 3) * 0.004;
        let time_s = 1.7e9 + f64::from(index) * 0.02 + late_s;
        let [motion, pressures] = sample(index);
        let _ = writeln!(text, "({time_s:.6}) can0 {MOTION}#{motion}");
        let _ = writeln!(text, "({:.6}) can0 {PRESSURES}#{pressures}", time_s + 6e-4);
    }
    text
}

pub fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

pub fn loaded(manifest: &str, log: &str) -> Run {
    let folder = folder(&[("campaign.toml", manifest), ("a.log", log)]);
    let campaign = Campaign::load(folder.path());
    campaign
        .unwrap_or_else(|error| panic!("{error}"))
        .runs
        .remove(0)
}

/// The message for a campaign, from the file's name on.
pub fn fault(files: &[(&str, &str)]) -> String {
    let folder = folder(files);
    let error = Campaign::load(folder.path())
        .expect_err("it is wrong")
        .to_string();
    let parent = format!("{}/", folder.path().display());
    error.replace(&parent, "")
}

pub fn fault_of_log(log: &str) -> String {
    fault(&[("campaign.toml", MANIFEST), ("a.log", log)])
}

/// The same samples as [`candump`], in the format of Vector's tools.
pub fn asc(samples: u16, notation: &str) -> String {
    let mut text = format!(
        "date Sat Nov 21 10:00:00.000 am 2026\nbase hex  timestamps {notation}\n// version 9.0.0\n\
         Begin Triggerblock Sat Nov 21 10:00:00.000 am 2026\n   0.000000 Start of measurement\n\
            0.000000 1  Statistic: D 0 R 0 XD 0 XR 0 E 0 O 0 B 0.00%\n   0.000000 CAN 1 Status:chip status error active\n"
    );
    for index in 0..samples {
        let time_s = if notation == "relative" {
            0.02
        } else {
            f64::from(index) * 0.02
        };
        let [motion, pressures] = sample(index).map(|data| {
            let bytes: Vec<&str> = (0..8).map(|byte| &data[2 * byte..2 * byte + 2]).collect();
            bytes.join(" ")
        });
        let after_s = if notation == "relative" { 0.0 } else { time_s };
        let _ = writeln!(
            text,
            " {time_s:.6} 1  {MOTION}x       Rx   d 8 {motion}  Length = 240000 BitCount = 124\n \
             {after_s:.6} CANFD   1 Rx   {PRESSURES}x  HitchPressures  1 0 8  8 {pressures}   0 0 0\n \
             {after_s:.6} 1  ErrorFrame\n {after_s:.6} 1  123  Tx   r"
        );
    }
    text + "End TriggerBlock\n"
}
