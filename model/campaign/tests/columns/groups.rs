//! Channels of MDF: names that occur in several groups, units of conversions, and the unit of times.

use std::fs;

use falcon_mdf::{Conversion, Mf4Writer, SignalValues};
use hitch_campaign::survey::Survey;
use hitch_campaign::{Campaign, Run};
use hitch_plant::Channel;
use tempfile::TempDir;

use crate::{campaign, loaded, samples};

const COLUMNS: &str = "[columns]\nlift_current_a = \"I @ group 2\"\nlower_current_a = \"I_lower\"\n\
    cylinder_pressure_bar = \"p_cyl\"\n";

/// A slow group with a set point and a fast one with a measurement of the same name, after them one without samples.
/// The pressure is in counts of 0.1 psi.
fn log() -> Vec<u8> {
    let column = |index: usize| samples().iter().map(|row| row[index]).collect::<Vec<f64>>();
    let slow: Vec<f64> = (0..20).map(|i| f64::from(i) * 0.1).collect();
    let mut writer = Mf4Writer::new();
    let group = writer.add_group(&slow).unwrap();
    group.add_channel("I", "mA", &[1_000.0; 20]).unwrap();
    let group = writer.add_group(&column(0)).unwrap();
    group.add_channel("I", "A", &column(1)).unwrap();
    group.add_channel("I_lower", "A", &column(2)).unwrap();
    let conversion = Conversion::Linear {
        offset: 0.0,
        factor: 0.1,
    };
    let counts: Vec<f64> = column(3)
        .iter()
        .map(|bar| bar / 0.689_475_729_3 * 100.0)
        .collect();
    let counts = SignalValues::F64(counts);
    group
        .add_channel_typed_with("p_cyl", "psi", counts, None, Some(conversion))
        .unwrap();
    group.add_channel("dt", "ms", &column(2)).unwrap();
    let group = writer.add_group(&[]).unwrap();
    group.add_channel("I_lower", "mA", &[]).unwrap();
    let mut bytes = Vec::new();
    writer.write(&mut bytes).unwrap();
    bytes
}

fn u64_at(bytes: &[u8], at: usize) -> u64 {
    u64::from_le_bytes(bytes[at..at + 8].try_into().unwrap())
}

/// Positions of the links to the conversion and to the unit, in each block of a channel.
fn links(bytes: &[u8]) -> Vec<[usize; 2]> {
    let blocks = bytes.windows(4).enumerate();
    let blocks = blocks.filter(|(_, kind)| kind == b"##CN");
    blocks.map(|(at, _)| [at + 56, at + 72]).collect()
}

/// Moves the unit of each channel with a conversion into the block of the conversion, as other tools do.
fn with_unit_of_conversion(mut bytes: Vec<u8>) -> Vec<u8> {
    let mut moved = 0;
    for [conversion, unit] in links(&bytes) {
        let conversion = u64_at(&bytes, conversion) as usize;
        if conversion != 0 {
            let link = bytes[unit..unit + 8].to_vec();
            bytes[conversion + 32..conversion + 40].copy_from_slice(&link);
            bytes[unit..unit + 8].fill(0);
            moved += 1;
        }
    }
    assert_eq!(moved, 1);
    bytes
}

/// States `ms` instead of `s` as the unit of each group's times.
fn with_times_in_ms(mut bytes: Vec<u8>) -> Vec<u8> {
    let links = links(&bytes);
    let unit = |at: usize| {
        let text = u64_at(&bytes, at) as usize + 24;
        bytes.get(text..text + 3).unwrap_or_default()
    };
    let places = links.iter().map(|[_, unit]| *unit);
    let of_seconds: Vec<usize> = places
        .clone()
        .filter(|at| unit(*at).starts_with(b"s\0"))
        .collect();
    let milliseconds = places.clone().find(|at| unit(*at) == b"ms\0").unwrap();
    let link = bytes[milliseconds..milliseconds + 8].to_vec();
    assert_eq!(of_seconds.len(), 3);
    for at in of_seconds {
        bytes[at..at + 8].copy_from_slice(&link);
    }
    bytes
}

fn assert_right(run: &Run) {
    let pressure = run.channel(Channel::CylinderPressure).unwrap();
    for (i, row) in samples().iter().enumerate() {
        assert_eq!(run.lift_current_a[i], row[1], "{i}");
        assert!((pressure[i] - row[3]).abs() < 1e-6, "{i}: {}", pressure[i]);
    }
}

#[test]
fn a_name_in_two_groups_is_told_apart_by_the_group() {
    let bytes = log();
    assert_right(&loaded("log.mf4", &bytes, COLUMNS));
    let dir = campaign("log.mf4", &bytes, &COLUMNS.replace(" @ group 2", ""));
    let said = Campaign::load(dir.path()).unwrap_err().to_string();
    assert!(
        said.contains(
            "2 channels are named \"I\", and [columns] does not say which is lift_current_a"
        ) && said.contains("assign \"I @ group 1\" or \"I @ group 2\""),
        "{said}"
    );
    let Survey::Channels { columns, .. } = Survey::of(&dir.path().join("log.mf4")).unwrap() else {
        panic!("these are channels");
    };
    let found: Vec<_> = columns
        .iter()
        .map(|column| {
            let unit = column.unit.as_deref();
            (column.name.as_str(), unit, column.values.len())
        })
        .collect();
    let expected = [
        ("I @ group 1", Some("mA"), 20),
        ("I @ group 2", Some("A"), 200),
        ("I_lower", Some("A"), 200),
        ("p_cyl", Some("psi"), 200),
        ("dt", Some("ms"), 200),
    ];
    assert_eq!(found, expected);
    assert!((columns[1].lasts_s.unwrap() - 1.99).abs() < 1e-9);
}

#[test]
fn a_channel_without_a_unit_has_that_of_its_conversion() {
    let bytes = with_unit_of_conversion(log());
    assert_right(&loaded("log.mf4", &bytes, COLUMNS));
    // Whatever the blocks of the units contain, nothing panics.
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("log.mf4");
    let conversion = bytes.windows(4).position(|kind| kind == b"##CC").unwrap();
    for at in conversion + 8..conversion + 48 {
        let mut broken = bytes.clone();
        broken[at] ^= 0xFF;
        fs::write(&path, broken).unwrap();
        if let Err(error) = Survey::of(&path) {
            assert_eq!(error.to_string().lines().count(), 1, "{error}");
        }
    }
}

#[test]
fn times_are_read_in_the_unit_that_they_state() {
    let dir = TempDir::new().unwrap();
    let path = dir.path().join("log.mf4");
    fs::write(&path, with_times_in_ms(log())).unwrap();
    let Survey::Channels { columns, .. } = Survey::of(&path).unwrap() else {
        panic!("these are channels");
    };
    assert!((columns[1].lasts_s.unwrap() - 0.001_99).abs() < 1e-12);
}
