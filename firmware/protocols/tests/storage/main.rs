//! The calibration in flash: power cuts, damage, and firmware that comes and goes.

mod fault_log;
mod flash;
mod fuzz;
mod pieces;
mod safety_block;
mod spared;

use embedded_storage::nor_flash::{ErrorType, NorFlash, ReadNorFlash};
use flash::{Flash, FlashError, PAGE, PAGES};
use hitch_protocols::storage::COPY_BYTES;
use hitch_protocols::storage::record::{Block, Carried};
use hitch_protocols::storage::{CalibrationStore, Copy, Progress, Source, StoreError, record};
use hitch_quantities::calibration::CALIBRATION_VERSION;
use hitch_quantities::calibration::calibration_words::{CALIBRATION_WORDS, items};
use hitch_quantities::crc32::Crc32;
use hitch_quantities::units::MicrometrePerSecond;
use hitch_quantities::{Calibration, ValidCalibration};

/// A calibration that can be told from others.
fn calibration(lift_speed: i32) -> ValidCalibration {
    let mut block = Calibration::nominal();
    block.position.lift_speed = MicrometrePerSecond(lift_speed);
    block.sealed().validate().unwrap()
}

fn loaded(flash: &Flash) -> (ValidCalibration, Source) {
    let loaded = CalibrationStore::new(flash.clone()).load();
    (loaded.calibration, loaded.source)
}

/// Flash in which both have been stored, one after the other.
fn flash_with(first: &ValidCalibration, second: &ValidCalibration) -> Flash {
    let mut store = CalibrationStore::new(Flash::blank());
    store.store(first).unwrap();
    store.store(second).unwrap();
    store.release()
}

/// Bytes that are programmed or erased when a calibration is stored.
fn bytes_changed() -> usize {
    let plenty = 1 << 30;
    let mut store = CalibrationStore::new(Flash {
        power: plenty,
        ..Flash::blank()
    });
    store.store(&calibration(2_000)).unwrap();
    plenty - store.release().power
}

/// A record in the first copy of blank flash.
fn flash_with_record(words: &[u32]) -> Flash {
    let mut flash = Flash::blank();
    let mut digest = Crc32::default();
    words
        .iter()
        .for_each(|word| digest.update(&word.to_le_bytes()));
    let all = words.iter().copied().chain([digest.value()]);
    let bytes: Vec<u8> = all.flat_map(u32::to_le_bytes).collect();
    flash.bytes[..bytes.len()].copy_from_slice(&bytes);
    flash
}

/// The words of a record of `calibration` by firmware that had one block, without its checksum.
fn record_of(calibration: &Calibration, sequence: u32) -> Vec<u32> {
    let words = calibration.to_words();
    let entries = |block: Block| block.words(&words, sequence).skip(record::HEADER_WORDS);
    let head = Block::Machine.words(&words, sequence).take(4);
    let all = entries(Block::Machine).chain(entries(Block::Safety));
    let mut record: Vec<u32> = head.chain(all).collect();
    record[2] = u32::try_from(record.len() + 1).unwrap();
    record
}

/// Where the machine block begins in a copy.
const MACHINE_BLOCK: usize = (4 * Block::Safety.record_words()).next_multiple_of(32);

/// Whether a byte of a copy belongs to a block; the last chunk of each is filled up.
fn is_used(byte: &usize) -> bool {
    let (block, place) = match byte.checked_sub(MACHINE_BLOCK) {
        Some(place) => (Block::Machine, place),
        None => (Block::Safety, *byte),
    };
    place < 4 * block.record_words()
}

/// The entry of a scalar in a record: where it stands.
fn entry_of(record: &[u32], word: usize) -> usize {
    let item = items().find(|item| item.first == word).unwrap();
    let head = (item.key << 8) | u32::from(item.count);
    record.iter().position(|&found| found == head).unwrap()
}

/// The word of `position.lift_speed` in a block.
fn lift_speed_word() -> usize {
    let (one, other) = (calibration(2_000).to_words(), calibration(3_000).to_words());
    let differ = |index: &usize| one[*index] != other[*index];
    (0..CALIBRATION_WORDS - 1).find(differ).unwrap()
}

#[test]
fn a_new_machine_runs_on_the_factorys_calibration_and_says_so() {
    let loaded = CalibrationStore::new(Flash::blank()).load();
    assert_eq!(loaded.calibration, ValidCalibration::nominal());
    assert_eq!(loaded.source, Source::Factory);
    assert_eq!(loaded.copies, [Copy::Blank, Copy::Blank]);
}

#[test]
fn what_is_stored_is_loaded_and_copies_take_turns() {
    let mut store = CalibrationStore::new(Flash::blank());
    for round in 1..=5_u32 {
        let stored = calibration(1_000 + round.cast_signed());
        store.store(&stored).unwrap();
        let loaded = store.load();
        assert_eq!(loaded.calibration, stored);
        let copy = usize::from(round % 2 == 0);
        assert_eq!(
            loaded.source,
            Source::Stored {
                copy,
                version: CALIBRATION_VERSION,
                carried: Carried::default()
            }
        );
        assert_eq!(loaded.copies[copy], Copy::Good { sequence: round });
    }
}

#[test]
fn the_newer_copy_counts_when_the_sequence_wraps() {
    let mut first = record_of(&calibration(2_000), 1);
    first[1] = u32::MAX;
    let mut store = CalibrationStore::new(flash_with_record(&first));
    store.store(&calibration(3_000)).unwrap();
    let loaded = store.load();
    assert_eq!(loaded.copies[1], Copy::Good { sequence: 0 });
    assert_eq!(loaded.calibration, calibration(3_000));
}

#[test]
fn a_power_cut_after_any_byte_leaves_the_old_calibration_or_the_new_one() {
    let (first, old, new) = (calibration(1_000), calibration(2_000), calibration(3_000));
    let before = flash_with(&first, &old);
    let all = bytes_changed();
    assert!(all > PAGE, "erasing and programming: {all}");
    // The byte under way is left as it was, half done, or done.
    for done in [0x00, 0x5A, 0xFF] {
        for power in 0..all {
            let mut store = CalibrationStore::new(Flash {
                power,
                done,
                ..before.clone()
            });
            assert_eq!(
                store.store(&new),
                Err(StoreError::Flash(FlashError)),
                "{power}"
            );
            let mut store = CalibrationStore::new(Flash {
                power: usize::MAX,
                ..store.release()
            });
            let loaded = store.load();
            // What may be missing at the very end is filling behind the checksum.
            let complete = loaded.calibration == new && power >= all - 32;
            assert!(
                loaded.calibration == old || complete,
                "{power} bytes, {done:02X}"
            );
            // And the machine isn't stuck with it.
            if power % 97 == 0 {
                store.store(&new).unwrap();
                assert_eq!(store.load().calibration, new);
            }
        }
    }
}

#[test]
fn a_power_cut_at_the_very_first_store_leaves_the_factorys() {
    for power in (0..bytes_changed() - 40).step_by(13) {
        let mut store = CalibrationStore::new(Flash {
            power,
            ..Flash::blank()
        });
        store.store(&calibration(3_000)).unwrap_err();
        let (calibration, source) = loaded(&store.release());
        assert_eq!(
            (calibration, source),
            (ValidCalibration::nominal(), Source::Factory)
        );
    }
}

#[test]
fn every_flipped_bit_of_the_newer_copy_gives_the_older_one() {
    let (old, new) = (calibration(2_000), calibration(3_000));
    let flash = flash_with(&old, &new);
    let start = PAGE * PAGES / 2;
    for bit in (0..COPY_BYTES)
        .filter(is_used)
        .flat_map(|byte| 8 * byte..8 * byte + 8)
    {
        let mut damaged = flash.clone();
        damaged.bytes[start + bit / 8] ^= 1 << (bit % 8);
        let mut store = CalibrationStore::new(damaged);
        let loaded = store.load();
        assert_eq!(loaded.calibration, old, "bit {bit}");
        assert_eq!(
            loaded.copies,
            [Copy::Good { sequence: 1 }, Copy::Damaged],
            "bit {bit}"
        );
    }
}

#[test]
fn two_damaged_copies_give_the_factorys_and_say_so() {
    let mut flash = flash_with(&calibration(2_000), &calibration(3_000));
    flash.bytes[100] ^= 4;
    flash.bytes[PAGE * PAGES / 2 + 100] ^= 4;
    let loaded = CalibrationStore::new(flash).load();
    assert_eq!(loaded.calibration, ValidCalibration::nominal());
    assert_eq!(loaded.source, Source::Factory);
    assert_eq!(loaded.copies, [Copy::Damaged, Copy::Damaged]);
}

#[test]
fn rubbish_in_flash_is_no_calibration() {
    let mut state = 1_u32;
    for _ in 0..200 {
        let mut flash = Flash::blank();
        for byte in &mut flash.bytes {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            *byte = state.to_le_bytes()[3];
        }
        // A head that looks right, with a length that isn't.
        flash.bytes[..4].copy_from_slice(b"HCAL");
        assert_eq!(loaded(&flash).1, Source::Factory);
    }
}

#[test]
fn a_calibration_of_another_layout_keeps_what_both_know() {
    let mut words = record_of(&calibration(2_000), 1);
    // An older firmware: its version, an entry that this one has dropped, and one missing that this one has added.
    words[3] = CALIBRATION_VERSION - 1;
    words.splice(4..4, [0xABCD_EF03, 1, 2, 3]);
    let last = words.len() - 2;
    words.truncate(last);
    words[2] = u32::try_from(words.len() + 1).unwrap();
    let (calibration, source) = loaded(&flash_with_record(&words));
    assert_eq!(
        calibration.position.lift_speed,
        MicrometrePerSecond(2_000),
        "kept"
    );
    let nominal = Calibration::nominal().safety.decay_time;
    assert_eq!(
        calibration.safety.decay_time, nominal,
        "the one that is new"
    );
    let carried = Carried {
        defaulted: 1,
        unknown: 1,
    };
    assert_eq!(
        source,
        Source::Stored {
            copy: 0,
            version: CALIBRATION_VERSION - 1,
            carried
        }
    );
}

#[test]
fn a_value_that_is_no_longer_in_range_gets_its_default() {
    let mut words = record_of(&calibration(2_000), 1);
    let speed = entry_of(&words, lift_speed_word());
    words[speed + 1] = 0;
    let (calibration, source) = loaded(&flash_with_record(&words));
    assert_eq!(calibration, ValidCalibration::nominal());
    let carried = Carried {
        defaulted: 1,
        unknown: 0,
    };
    assert_eq!(
        source,
        Source::Stored {
            copy: 0,
            version: CALIBRATION_VERSION,
            carried
        }
    );
}

#[test]
fn a_record_that_makes_no_calibration_is_passed_over() {
    let mut crossed = Calibration::nominal();
    std::mem::swap(
        &mut crossed.position.lower_limit,
        &mut crossed.position.upper_limit,
    );
    let words: Vec<u32> = record_of(&crossed, 1);
    assert_eq!(loaded(&flash_with_record(&words)).1, Source::Factory);
}

#[test]
fn a_record_without_any_entry_that_is_known_is_passed_over() {
    let head = record_of(&calibration(2_000), 1)[..4].to_vec();
    for entries in [&[][..], &[0xABCD_EF03, 1, 2, 3]] {
        let mut words = [&head, entries].concat();
        words[2] = u32::try_from(words.len() + 1).unwrap();
        assert_eq!(loaded(&flash_with_record(&words)).1, Source::Factory);
    }
}

#[test]
fn items_have_keys_of_their_own_and_cover_the_block() {
    let all: Vec<_> = items().collect();
    let mut next = 1;
    for (index, item) in all.iter().enumerate() {
        assert!(
            all[..index].iter().all(|other| other.key != item.key),
            "{item:?}"
        );
        assert_eq!(item.first, next);
        next += usize::from(item.count);
    }
    assert_eq!(next, CALIBRATION_WORDS - 1, "all but version and checksum");
}

#[test]
fn storing_is_done_in_steps_of_a_page_or_a_chunk() {
    let mut store = CalibrationStore::new(Flash::blank());
    assert_eq!(store.step(), Ok(Progress::Idle));
    store.begin(&calibration(2_000)).unwrap();
    assert_eq!(store.begin(&calibration(2_000)), Err(StoreError::Busy));
    let mut steps = 0;
    while store.step().unwrap() == Progress::Busy {
        steps += 1;
    }
    assert_eq!(steps, COPY_BYTES.div_ceil(PAGE) + COPY_BYTES / 32);
    assert_eq!(store.step(), Ok(Progress::Idle));
}

#[test]
fn worn_out_flash_is_noticed_and_what_was_stored_stays() {
    /// Flash in which a bit sticks.
    struct Worn(Flash, usize);
    impl ErrorType for Worn {
        type Error = FlashError;
    }
    impl ReadNorFlash for Worn {
        const READ_SIZE: usize = 1;
        fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
            self.0.read(offset, bytes)
        }
        fn capacity(&self) -> usize {
            self.0.capacity()
        }
    }
    impl NorFlash for Worn {
        const WRITE_SIZE: usize = 8;
        const ERASE_SIZE: usize = PAGE;
        fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
            self.0.erase(from, to)
        }
        fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
            self.0.write(offset, bytes)?;
            self.0.bytes[self.1] = 0x00;
            Ok(())
        }
    }
    let old = calibration(2_000);
    let mut store = CalibrationStore::new(Flash::blank());
    store.store(&old).unwrap();
    let mut store = CalibrationStore::new(Worn(store.release(), PAGE * PAGES / 2 + 40));
    assert_eq!(store.store(&calibration(3_000)), Err(StoreError::Verify));
    assert_eq!(store.load().calibration, old);
    assert_eq!(
        store.store(&calibration(3_000)),
        Err(StoreError::Verify),
        "and again"
    );
}

#[test]
fn flash_that_is_too_small_is_refused() {
    let mut store = CalibrationStore::new(Flash {
        bytes: vec![0xFF; 2 * PAGE],
        ..Flash::blank()
    });
    assert_eq!(store.store(&calibration(2_000)), Err(StoreError::TooSmall));
}

#[test]
fn an_entry_that_is_cut_off_gets_its_default() {
    let mut words = record_of(&calibration(2_000), 1);
    words.pop();
    words[2] = u32::try_from(words.len() + 1).unwrap();
    let (calibration, source) = loaded(&flash_with_record(&words));
    let nominal = Calibration::nominal().safety;
    assert_eq!(calibration.safety, nominal);
    let carried = Carried {
        defaulted: 1,
        unknown: 0,
    };
    assert!(matches!(source, Source::Stored { carried: found, .. } if found == carried));
}
