//! Any course of storing, power cuts, torn contents, useless contents and read errors.

use hitch_quantities::crc32::Crc32;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::flash::Shared;
use super::*;

/// Half of the flash: where the second copy starts.
const SECOND: usize = PAGE * PAGES / 2;
/// Programmed or erased by no store that is complete.
const PLENTY: usize = 1 << 30;

/// What happens to an ECU.
#[derive(Clone, Debug)]
enum Event {
    /// A calibration is stored with power to the end.
    Store,
    /// Power fails after a share of the bytes, thousandths; the byte, page or chunk under way is torn.
    CutStore(usize, u8, Vec<u8>),
    /// Power is switched off and on.
    Restart,
    /// The same, and from then on a byte of a copy can't be read until the next restart.
    RestartUnreadable { copy: usize, byte: usize },
    /// A byte of a copy can't be read from now on until the next restart.
    Unreadable { copy: usize, byte: usize },
    /// The copy that isn't in use gets a record that passes its checksum and makes no calibration.
    Useless { ahead: u32 },
    /// The copy that isn't in use gets anything behind a header that looks right, with a checksum that fits.
    Rubbish { ahead: u32, byte: u8 },
}

fn event() -> impl Strategy<Value = Event> {
    let place = (0..2_usize, 0..COPY_BYTES);
    let torn = prop::collection::vec(any::<u8>(), 0..40);
    prop_oneof![
        3 => Just(Event::Store),
        4 => (0..1_000_usize, any::<u8>(), torn).prop_map(|(share, done, torn)| Event::CutStore(share, done, torn)),
        2 => Just(Event::Restart),
        1 => place.clone().prop_map(|(copy, byte)| Event::RestartUnreadable { copy, byte }),
        1 => place.prop_map(|(copy, byte)| Event::Unreadable { copy, byte }),
        1 => any::<u32>().prop_map(|ahead| Event::Useless { ahead }),
        1 => (any::<u32>(), any::<u8>()).prop_map(|(ahead, byte)| Event::Rubbish { ahead, byte }),
    ]
}

/// An ECU's store, and what may be loaded from it.
struct Machine {
    flash: Shared,
    store: CalibrationStore<Shared>,
    /// Number of the calibration in use, and where it stands.
    used: Option<(i32, usize)>,
    /// One in the other copy that is complete.
    other: Option<i32>,
    /// Those whose storing began and didn't end, and one that couldn't be read for a while.
    pending: Vec<i32>,
    /// The last calibration's number.
    last: i32,
}

impl Machine {
    /// Nothing is stored; sequences begin shortly before they wrap.
    fn new() -> Self {
        let mut first = record_of(&calibration(1_000), 1);
        first[1] = u32::MAX - 2;
        let flash = Shared::new(flash_with_record(&first));
        let mut machine = Self {
            store: CalibrationStore::new(flash.clone()),
            flash,
            used: Some((1_000, 0)),
            other: None,
            pending: Vec::new(),
            last: 1_000,
        };
        machine.restart(None);
        machine
    }

    fn happens(&mut self, event: Event) {
        match event {
            Event::Store => self.store(PLENTY),
            Event::CutStore(share, done, torn) => {
                (self.flash.flash().done, self.flash.flash().torn) = (done, torn);
                self.store(share * bytes_changed() / 1_000);
                self.restart(None);
            }
            Event::Restart => self.restart(None),
            Event::RestartUnreadable { copy, byte } => self.restart(Some(copy * SECOND + byte)),
            Event::Unreadable { copy, byte } => {
                let at = copy * SECOND + byte;
                self.flash.flash().unreadable = at..at + 1;
            }
            Event::Useless { ahead } => self.forge(ahead, spared::useless_record),
            Event::Rubbish { ahead, byte } => self.forge(ahead, |sequence| {
                let mut bytes = spared::useless_record(sequence);
                let end = bytes.len() - 4;
                bytes[16..end]
                    .iter_mut()
                    .for_each(|found| *found ^= byte | 1);
                let mut digest = Crc32::default();
                digest.update(&bytes[..end]);
                bytes[end..].copy_from_slice(&digest.value().to_le_bytes());
                bytes
            }),
        }
    }

    /// Stores a calibration that was never there before.
    fn store(&mut self, power: usize) {
        self.last += 1;
        self.pending.push(self.last);
        self.flash.flash().power = power;
        let stored = self.store.store(&calibration(self.last));
        if stored.is_ok() {
            self.other = self.used.map(|(number, _)| number);
            self.used = Some((self.last, self.used.map_or(0, |(_, copy)| 1 - copy)));
            self.pending.clear();
        } else {
            // At most one byte of it may have been changed.
            self.pending.extend(self.other.take());
        }
    }

    /// Loads what is stored; a byte may be unreadable.
    fn restart(&mut self, unreadable: Option<usize>) {
        let flash = self.flash.flash().clone().powered();
        self.flash = Shared::new(flash);
        if let Some(at) = unreadable {
            self.flash.flash().unreadable = at..at + 1;
        }
        self.store = CalibrationStore::new(self.flash.clone());
        let found = self.store.load();
        let number = found.calibration.position.lift_speed.0;
        let Source::Stored { copy, .. } = found.source else {
            let only = unreadable.is_some() && self.other.is_none();
            assert!(
                only,
                "the factory's instead of {:?}, pending {:?}",
                self.used, self.pending
            );
            // A byte that can be read again brings it back.
            return self.restart(None);
        };
        let is_known =
            self.used.is_some_and(|(used, _)| used == number) || self.pending.contains(&number);
        let is_degraded = unreadable.is_some() && self.other == Some(number);
        assert!(
            is_known || is_degraded,
            "{number} instead of {:?}, pending {:?}, the other one {:?}",
            self.used,
            self.pending,
            self.other
        );
        let before = self.used.map(|(number, _)| number);
        if before == Some(number) {
            return;
        }
        // Both copies are complete now.
        self.other = None;
        self.pending.clear();
        if is_degraded {
            self.pending.extend(before)
        } else {
            self.other = before
        }
        self.used = Some((number, copy));
    }

    /// Puts contents into the copy that isn't in use, `ahead` of the sequence in use.
    fn forge(&mut self, ahead: u32, contents: impl Fn(u32) -> Vec<u8>) {
        let Some((_, used)) = self.used else { return };
        let start = used * SECOND;
        let sequence = self.flash.flash().bytes[start + 4..start + 8]
            .try_into()
            .unwrap();
        let bytes = contents(u32::from_le_bytes(sequence).wrapping_add(ahead));
        let other = (1 - used) * SECOND;
        self.flash.flash().bytes[other..other + bytes.len()].copy_from_slice(&bytes);
        self.other = None;
        self.pending.clear();
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(7),
        failure_persistence: None,
        ..ProptestConfig::with_cases(400)
    })]

    #[test]
    fn whatever_happens_the_last_calibration_or_the_one_being_stored_is_loaded(
        events in prop::collection::vec(event(), 1..40)
    ) {
        let mut machine = Machine::new();
        for event in events {
            machine.happens(event);
        }
        machine.restart(None);
    }
}
