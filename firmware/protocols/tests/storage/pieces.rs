//! Pages, chunks and lengths: how much of the flash is erased, programmed and read.

use super::flash::Shared;
use super::*;

/// Half of the flash: where the second copy starts.
const SECOND: usize = PAGE * PAGES / 2;

/// Flash with pages of 32 bytes that counts how many are erased.
struct Fine {
    bytes: Vec<u8>,
    erased: usize,
}

impl ErrorType for Fine {
    type Error = FlashError;
}

impl ReadNorFlash for Fine {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), FlashError> {
        let from = offset as usize;
        bytes.copy_from_slice(&self.bytes[from..from + bytes.len()]);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for Fine {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = 32;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), FlashError> {
        self.bytes[from as usize..to as usize].fill(0xFF);
        self.erased += (to - from) as usize / Self::ERASE_SIZE;
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), FlashError> {
        let from = offset as usize;
        let target = &mut self.bytes[from..from + bytes.len()];
        assert!(target.iter().all(|&byte| byte == 0xFF), "not erased");
        target.copy_from_slice(bytes);
        Ok(())
    }
}

#[test]
fn a_copy_that_is_just_large_enough_is_used_and_no_page_behind_it_is_erased() {
    let fine = |bytes: usize| Fine {
        bytes: vec![0; bytes],
        erased: 0,
    };
    let mut store = CalibrationStore::new(fine(2 * COPY_BYTES));
    for round in 1..=2 {
        let stored = calibration(2_000 + round);
        store.store(&stored).unwrap();
        assert_eq!(store.load().calibration, stored);
    }
    assert_eq!(store.release().erased, 2 * COPY_BYTES / 32);
    let mut store = CalibrationStore::new(fine(2 * COPY_BYTES - 64));
    assert_eq!(store.store(&calibration(2_000)), Err(StoreError::TooSmall));
}

#[test]
fn flash_that_does_not_take_a_record_is_noticed_though_an_older_one_is_there() {
    let used = calibration(2_000);
    let mut flash = flash_with(&calibration(1_000), &used);
    flash.protected = true;
    let mut store = CalibrationStore::new(flash);
    assert_eq!(store.store(&calibration(3_000)), Err(StoreError::Verify));
    assert_eq!(store.load().calibration, used);
}

#[test]
fn a_record_that_says_that_it_is_longer_than_its_copy_is_not_read() {
    let mut words = record_of(&calibration(2_000), 1);
    for (length, reads) in [(SECOND / 4, 2..=SECOND / 32), (SECOND / 4 + 1, 2..=2)] {
        words[2] = u32::try_from(length).unwrap();
        let shared = Shared::new(flash_with_record(&words));
        let found = CalibrationStore::new(shared.clone()).load();
        assert_eq!(found.copies, [Copy::Damaged, Copy::Blank]);
        // Two of them are of the blank copy, one for each block.
        let read = shared.flash().reads - 2;
        assert!(reads.contains(&read), "{length} words: {read} reads");
    }
}

#[test]
fn a_useless_record_that_stays_is_older_than_what_is_stored() {
    let mut flash = Flash::blank();
    let useless = spared::useless_record(7);
    flash.bytes[SECOND..SECOND + useless.len()].copy_from_slice(&useless);
    let mut store = CalibrationStore::new(flash);
    let new = calibration(3_000);
    store.store(&new).unwrap();
    let loaded = store.load();
    assert_eq!(loaded.calibration, new);
    assert_eq!(loaded.copies[0], Copy::Good { sequence: 8 });
}

#[test]
fn of_two_copies_of_which_one_cannot_be_read_that_one_is_stored_over() {
    for (start, protected) in [(0, SECOND), (SECOND, 0)] {
        let mut flash = flash_with(&calibration(1_000), &calibration(2_000));
        flash.bytes[protected..protected + SECOND].fill(0xFF);
        flash.unreadable = start..start + 1;
        let mut store = CalibrationStore::new(flash);
        store.store(&calibration(3_000)).unwrap_err();
        let bytes = store.release().bytes;
        let rest = &bytes[protected..protected + SECOND];
        assert!(rest.iter().all(|&byte| byte == 0xFF), "{start}");
    }
}
