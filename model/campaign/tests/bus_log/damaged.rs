//! Damaged logs of a bus and damaged descriptions of its messages: read, or refused in one line.

use std::fs;

use hitch_campaign::Campaign;
use hitch_campaign::survey::bus_signals;
use proptest::prelude::*;
use tempfile::TempDir;

use crate::descriptions::described;
use crate::logs::{MANIFEST, asc, candump};

/// A change of some bytes.
#[derive(Debug, Clone)]
enum Damage {
    Flipped(prop::sample::Index, u8),
    Inserted(prop::sample::Index, u8),
    Removed(prop::sample::Index),
    CutOff(prop::sample::Index),
}

fn damage() -> impl Strategy<Value = Damage> {
    let place = any::<prop::sample::Index>;
    prop_oneof![
        6 => (place(), 0..8_u8).prop_map(|(at, bit)| Damage::Flipped(at, bit)),
        2 => (place(), any::<u8>()).prop_map(|(at, byte)| Damage::Inserted(at, byte)),
        2 => place().prop_map(Damage::Removed),
        1 => place().prop_map(Damage::CutOff),
    ]
}

impl Damage {
    fn apply(&self, bytes: &mut Vec<u8>) {
        if bytes.is_empty() {
            return;
        }
        match self {
            Self::Flipped(at, bit) => {
                let at = at.index(bytes.len());
                bytes[at] ^= 1 << bit;
            }
            Self::Inserted(at, byte) => bytes.insert(at.index(bytes.len()), *byte),
            Self::Removed(at) => drop(bytes.remove(at.index(bytes.len()))),
            Self::CutOff(at) => bytes.truncate(at.index(bytes.len())),
        }
    }
}

/// A campaign of which one file is damaged.
fn damaged(files: &[(&str, String)], broken: usize, damages: &[Damage]) -> TempDir {
    let folder = TempDir::new().unwrap();
    for (index, (name, text)) in files.iter().enumerate() {
        let mut bytes = text.clone().into_bytes();
        if index == broken {
            damages.iter().for_each(|damage| damage.apply(&mut bytes));
        }
        fs::write(folder.path().join(name), bytes).unwrap();
    }
    folder
}

/// A message of one line, or runs with enough samples.
fn is_read_or_refused(folder: &TempDir) -> Result<(), TestCaseError> {
    match Campaign::load(folder.path()) {
        Ok(campaign) => prop_assert!(campaign.runs.iter().all(|run| run.time_s.len() >= 10)),
        Err(error) => prop_assert_eq!(error.to_string().lines().count(), 1, "{}", error),
    }
    Ok(())
}

/// The number of cases of a property: few by day, many with `HITCH_THOROUGH`.
fn cases(few: u32, many: u32) -> u32 {
    match std::env::var_os("HITCH_THOROUGH") {
        Some(_) => many,
        None => few,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(64, 16_384), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn a_damaged_log_is_read_or_refused(
        of_vector in any::<bool>(),
        damages in prop::collection::vec(damage(), 1..6),
    ) {
        let (name, log) = if of_vector { ("a.asc", asc(20, "absolute")) } else { ("a.log", candump(20)) };
        let manifest = MANIFEST.replace("a.log", name);
        let files = [("campaign.toml", manifest), (name, log)];
        is_read_or_refused(&damaged(&files, 1, &damages))?;
    }

    #[test]
    fn a_damaged_description_is_read_or_refused(damages in prop::collection::vec(damage(), 1..6)) {
        let [manifest, description, log] = described();
        let files = [("campaign.toml", manifest), ("a.dbc", description), ("a.log", log)];
        let folder = damaged(&files, 1, &damages);
        is_read_or_refused(&folder)?;
        let [log, description] = ["a.log", "a.dbc"].map(|name| folder.path().join(name));
        if let Err(error) = bus_signals(&log, &description) {
            prop_assert_eq!(error.to_string().lines().count(), 1, "{}", error);
        }
    }
}

#[test]
fn of_a_log_that_is_cut_off_the_whole_frames_are_kept() {
    for (name, log) in [("a.asc", asc(20, "absolute")), ("a.log", candump(20))] {
        let manifest = MANIFEST.replace("a.log", name);
        let line = log.trim_end().rfind('\n').unwrap() + 1;
        for length in line + 2..log.trim_end().len() {
            let files = [
                ("campaign.toml", manifest.clone()),
                (name, log[..length].to_owned()),
            ];
            let folder = damaged(&files, 1, &[]);
            let campaign = Campaign::load(folder.path()).unwrap_or_else(|error| panic!("{error}"));
            assert!(campaign.runs[0].time_s.len() >= 19, "{name} {length}");
        }
    }
}
