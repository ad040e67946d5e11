//! The block of safety values: power cuts between the blocks, damage, and firmware that had one block.

use hitch_protocols::storage::SafetySource;
use hitch_quantities::units::Millisecond;

use super::*;

/// A calibration that can be told from others by a value of each block.
fn both(lift_speed: i32, open_time: i32) -> ValidCalibration {
    let mut block = (*calibration(lift_speed)).clone();
    block.safety.open_time = Millisecond(open_time);
    block.seal().unwrap()
}

#[test]
fn a_power_cut_between_the_blocks_leaves_both_old_or_both_new() {
    let (old, new) = (both(2_000, 20), both(3_000, 30));
    let before = flash_with(&both(1_000, 10), &old);
    let mut news = 0;
    for power in 0..=bytes_changed() {
        let mut store = CalibrationStore::new(Flash {
            power,
            ..before.clone()
        });
        let _ = store.store(&new);
        let loaded = CalibrationStore::new(store.release().powered()).load();
        assert_eq!(loaded.safety, SafetySource::Stored, "{power}");
        assert!([&old, &new].contains(&&loaded.calibration), "{power}");
        news += usize::from(loaded.calibration == new);
    }
    assert!(news > 0);
}

#[test]
fn a_first_storing_that_is_cut_loses_no_safety_values() {
    for done in [0x00, 0x5A, 0xFF] {
        for power in 0..bytes_changed() {
            let mut store = CalibrationStore::new(Flash {
                power,
                done,
                ..Flash::blank()
            });
            store.store(&both(2_000, 20)).unwrap_err();
            let loaded = CalibrationStore::new(store.release().powered()).load();
            assert_ne!(loaded.safety, SafetySource::Lost, "{power}");
        }
    }
}

#[test]
fn a_damaged_safety_block_gives_the_other_copy_and_two_of_them_are_lost() {
    let (old, new) = (both(2_000, 20), both(3_000, 30));
    let half = PAGE * PAGES / 2;
    let mut flash = flash_with(&old, &new);
    flash.bytes[half + 100] ^= 1;
    let loaded = CalibrationStore::new(flash.clone()).load();
    assert_eq!(
        (loaded.calibration, loaded.safety),
        (old, SafetySource::Stored)
    );
    flash.bytes[100] ^= 1;
    let loaded = CalibrationStore::new(flash).load();
    assert_eq!(loaded.source, Source::Factory);
    assert_eq!(loaded.safety, SafetySource::Lost);
}

#[test]
fn the_only_safety_block_that_is_damaged_is_lost_and_not_replaced_in_silence() {
    let mut store = CalibrationStore::new(Flash::blank());
    store.store(&both(2_000, 20)).unwrap();
    let flash = store.release();
    for byte in (0..4 * Block::Safety.record_words()).step_by(7) {
        let mut flash = flash.clone();
        flash.bytes[byte] ^= 0x10;
        let loaded = CalibrationStore::new(flash).load();
        assert_eq!(loaded.safety, SafetySource::Lost, "byte {byte}");
    }
}

#[test]
fn safety_values_survive_the_loss_of_both_machine_blocks() {
    let mut flash = flash_with(&both(2_000, 20), &both(3_000, 30));
    flash.bytes[MACHINE_BLOCK + 100] ^= 1;
    flash.bytes[PAGE * PAGES / 2 + MACHINE_BLOCK + 100] ^= 1;
    let mut store = CalibrationStore::new(flash);
    let loaded = store.load();
    assert_eq!(loaded.source, Source::Factory);
    assert_eq!(loaded.safety, SafetySource::Stored);
    assert_eq!(loaded.calibration.safety.open_time, Millisecond(30));
    assert_eq!(store.safety_sequence(), 2);
    // The block that is in use is not the one that is written over.
    let before = store.release();
    for power in (0..bytes_changed()).step_by(11) {
        let mut store = CalibrationStore::new(Flash {
            power,
            ..before.clone()
        });
        store.store(&both(4_000, 40)).unwrap_err();
        let loaded = CalibrationStore::new(store.release().powered()).load();
        let found = loaded.calibration.safety.open_time;
        assert!([30, 40].map(Millisecond).contains(&found), "{power}");
    }
}

#[test]
fn a_record_of_firmware_with_one_block_keeps_its_safety_values() {
    let words = record_of(&both(2_000, 20), 9);
    let mut store = CalibrationStore::new(flash_with_record(&words));
    let loaded = store.load();
    assert_eq!(loaded.calibration, both(2_000, 20));
    assert_eq!(loaded.safety, SafetySource::Stored);
    store.store(&both(3_000, 30)).unwrap();
    assert_eq!(store.load().calibration, both(3_000, 30));
    assert_eq!(store.safety_sequence(), 10);
}

#[test]
fn the_safety_block_has_a_number_that_rises_with_each_storing() {
    let mut store = CalibrationStore::new(Flash::blank());
    for number in 1..5 {
        store.store(&both(2_000, 20)).unwrap();
        assert_eq!(store.safety_sequence(), number);
    }
}
