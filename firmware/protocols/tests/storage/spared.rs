//! The copy whose calibration is in use is never erased, and one that can't be read doesn't hide the other.

use super::flash::Shared;
use super::*;

/// Half of the flash: where the second copy starts.
const SECOND: usize = PAGE * PAGES / 2;

/// The bytes of a record that passes its checksum and makes no calibration: its limits are crossed.
pub fn useless_record(sequence: u32) -> Vec<u8> {
    let mut crossed = Calibration::nominal();
    std::mem::swap(
        &mut crossed.position.lower_limit,
        &mut crossed.position.upper_limit,
    );
    let words = record_of(&crossed, sequence);
    let flash = flash_with_record(&words);
    flash.bytes[..4 * (words.len() + 1)].to_vec()
}

#[test]
fn a_newest_copy_that_makes_no_calibration_is_the_one_that_is_stored_over() {
    let (used, new) = (calibration(2_000), calibration(3_000));
    for copy in [0, 1] {
        let mut before = flash_with(&calibration(1_000), &used);
        if copy == 0 {
            before.bytes.rotate_left(SECOND);
        }
        // The sequence of the copy in use is 2; these are newer by one and by as much as a sequence can be.
        for sequence in [3, 2 + i32::MAX.cast_unsigned()] {
            let other = (1 - copy) * SECOND;
            let useless = useless_record(sequence);
            before.bytes[other..other + useless.len()].copy_from_slice(&useless);
            let found = CalibrationStore::new(before.clone()).load();
            assert_eq!(
                (found.calibration, found.copies[1 - copy]),
                (used.clone(), Copy::Damaged)
            );
            for power in (0..bytes_changed() - 40).step_by(7) {
                let mut store = CalibrationStore::new(Flash {
                    power,
                    ..before.clone()
                });
                store.store(&new).unwrap_err();
                assert_eq!(
                    loaded(&store.release()).0,
                    used,
                    "copy {copy}, power cut after {power} bytes"
                );
            }
            let mut store = CalibrationStore::new(before.clone());
            store.store(&new).unwrap();
            assert_eq!(
                loaded(&store.release()).0,
                new,
                "copy {copy}, sequence {sequence}"
            );
        }
    }
}

#[test]
fn a_copy_that_cannot_be_read_counts_as_damaged_and_the_other_one_is_used() {
    let (old, new) = (calibration(2_000), calibration(3_000));
    let flash = flash_with(&old, &new);
    for byte in (0..COPY_BYTES).step_by(32) {
        for (start, expected) in [(0, &new), (SECOND, &old)] {
            let mut store = CalibrationStore::new(Flash {
                unreadable: start + byte..start + byte + 1,
                ..flash.clone()
            });
            let found = store.load();
            assert_eq!(
                &found.calibration, expected,
                "byte {byte} of the copy at {start}"
            );
            assert_eq!(found.copies[start / SECOND], Copy::Damaged);
        }
    }
}

#[test]
fn a_copy_that_cannot_be_read_when_storing_begins_is_not_erased_if_it_is_in_use() {
    let (old, used, new) = (calibration(1_000), calibration(2_000), calibration(3_000));
    let shared = Shared::new(flash_with(&old, &used));
    let mut store = CalibrationStore::new(shared.clone());
    assert_eq!(store.load().calibration, used);
    shared.flash().unreadable = SECOND..SECOND + 1;
    shared.flash().power = 100;
    store.store(&new).unwrap_err();
    assert_eq!(loaded(&shared.flash().clone().powered()).0, used);
}

#[test]
fn without_a_calibration_a_damaged_copy_is_stored_over_before_a_blank_one() {
    let mut flash = flash_with(&calibration(1_000), &calibration(2_000));
    flash.bytes[..SECOND].fill(0xFF);
    // The second copy can't be read now. If it could be read again later, it would be the newer one.
    flash.unreadable = SECOND..SECOND + 1;
    let mut store = CalibrationStore::new(flash);
    assert_eq!(store.load().source, Source::Factory);
    let new = calibration(3_000);
    // What was stored can't be read back either, which is reported.
    store.store(&new).unwrap_err();
    assert_eq!(loaded(&store.release().powered()).0, new);
}
