//! Damaged files of level 4: read, or refused with a reason; SciPy's files of both levels are damaged in `host-tests`.

use hitch_mat_file::{Value, is_one, variables};
use proptest::prelude::*;

/// A matrix as the format defines it: the kind of its numbers, rows, columns, no imaginary part, the name, the numbers.
fn matrix(kind: u32, [rows, columns]: [u32; 2], name: &str, numbers: &[u8]) -> Vec<u8> {
    let header = [kind, rows, columns, 0, name.len() as u32 + 1];
    let mut bytes: Vec<u8> = header.into_iter().flat_map(u32::to_le_bytes).collect();
    bytes.extend_from_slice(name.as_bytes());
    bytes.push(0);
    bytes.extend_from_slice(numbers);
    bytes
}

/// A file with times, a current of 16 bits, and a text.
fn file() -> Vec<u8> {
    let times: Vec<u8> = (0..20)
        .flat_map(|row| (0.5 * f64::from(row)).to_le_bytes())
        .collect();
    let currents: Vec<u8> = (0..20_i16).flat_map(i16::to_le_bytes).collect();
    let text: Vec<u8> = "oil"
        .chars()
        .flat_map(|c| f64::from(u32::from(c)).to_le_bytes())
        .collect();
    [
        matrix(0, [20, 1], "t", &times),
        matrix(30, [20, 1], "lift", &currents),
        matrix(1, [1, 3], "note", &text),
    ]
    .concat()
}

#[test]
fn numbers_of_any_kind_and_texts_are_read() {
    let read = variables(&file()).unwrap();
    let names: Vec<&str> = read.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["t", "lift", "note"]);
    let numbers = |factor: f64| Value::Numbers {
        size: [20, 1],
        values: (0..20).map(|row| factor * f64::from(row)).collect(),
    };
    assert_eq!(read[0].1, numbers(0.5));
    assert_eq!(read[1].1, numbers(1.0));
    assert_eq!(read[2].1, Value::Text("oil".to_owned()));
    assert!(is_one(&file()) && !is_one(b"time_s,lift_current_a\n0,1\n0.02,1\n"));
}

#[test]
fn a_file_that_is_cut_off_or_claims_too_much_is_refused() {
    let whole = file();
    let ends = [0, 20 + 2 + 160, 2 * (20 + 2) + 160 + 3 + 40, whole.len()];
    for length in 0..=whole.len() {
        let is_whole = ends.contains(&length);
        assert_eq!(variables(&whole[..length]).is_ok(), is_whole, "{length}");
    }
    let huge = matrix(0, [u32::MAX, u32::MAX], "t", &[]);
    assert!(
        variables(&huge)
            .unwrap_err()
            .contains("4294967295 by 4294967295")
    );
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: if std::env::var_os("HITCH_THOROUGH").is_some() { 100_000 } else { 500 },
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Damage neither panics nor makes numbers that the file does not have.
    #[test]
    fn a_damaged_file_is_read_or_refused(
        edits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = file();
        for (at, byte) in edits {
            let at = at.index(bytes.len());
            bytes[at] ^= byte;
        }
        for (_, value) in variables(&bytes).unwrap_or_default() {
            if let Value::Numbers { values, .. } = value {
                prop_assert!(values.len() <= bytes.len());
            }
        }
    }
}
