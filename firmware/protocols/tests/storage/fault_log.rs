//! The log of faults: power cuts, torn entries, compaction, and how often the flash is erased.

use hitch_protocols::j1939::diagnostics::{KINDS, Occurrences};
use hitch_protocols::j1939::trouble::Code;
use hitch_protocols::storage::fault_history::{FaultHistory, MOST_WRITES, WRITES_PER_ERASE};
use hitch_protocols::storage::fault_log::{Entry, FaultLog, LogError, MOST_SLOTS};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::flash::Shared;
use super::*;

/// Half of the flash: where the second page starts.
const SECOND: usize = PAGE * PAGES / 2;
/// Programmed or erased by nothing that is complete.
const PLENTY: usize = 1 << 30;
/// Bytes of a slot.
const SLOT: usize = 8;

fn entry(number: u32, count: u8) -> Entry {
    Entry {
        code: Code {
            spn: 520_192 + number,
            fmi: 31,
        },
        count,
    }
}

fn entries(flash: &Flash) -> Vec<Entry> {
    FaultLog::open(flash.clone().powered()).entries().collect()
}

/// Flash with two entries.
fn with_two() -> Flash {
    let shared = Shared::new(Flash::blank());
    let mut log = FaultLog::open(shared.clone());
    log.append(entry(1, 1)).unwrap();
    log.append(entry(2, 7)).unwrap();
    shared.flash().clone()
}

#[test]
fn entries_are_found_after_a_restart_in_their_order() {
    let flash = with_two();
    assert_eq!(entries(&flash), [entry(1, 1), entry(2, 7)]);
    let largest = Entry {
        code: Code {
            spn: (1 << 19) - 1,
            fmi: 31,
        },
        count: 126,
    };
    let shared = Shared::new(flash);
    FaultLog::open(shared.clone()).append(largest).unwrap();
    assert_eq!(
        entries(&shared.flash()),
        [entry(1, 1), entry(2, 7), largest]
    );
}

#[test]
fn blank_flash_is_neither_erased_nor_programmed_until_there_is_a_fault() {
    let shared = Shared::new(Flash::blank());
    shared.flash().power = PLENTY;
    let mut history = FaultHistory::open(shared.clone());
    assert!(!history.update(&[0; KINDS]));
    assert_eq!(shared.flash().power, PLENTY);
}

#[test]
fn a_power_cut_at_any_byte_of_an_entry_loses_that_one_at_most() {
    for (done, torn) in [(0, vec![]), (0xA5, vec![]), (0x5A, vec![0x3C, 0xFF, 0])] {
        for power in 0..SLOT {
            let shared = Shared::new(Flash {
                power,
                done,
                torn: torn.clone(),
                ..with_two()
            });
            let lost = FaultLog::open(shared.clone()).append(entry(3, 1));
            assert_eq!(lost, Err(LogError::Flash));
            let after = Shared::new(shared.flash().clone().powered());
            assert_eq!(entries(&after.flash()), [entry(1, 1), entry(2, 7)]);
            FaultLog::open(after.clone()).append(entry(4, 9)).unwrap();
            assert_eq!(
                entries(&after.flash()),
                [entry(1, 1), entry(2, 7), entry(4, 9)],
                "after a cut at byte {power}"
            );
        }
    }
}

#[test]
fn a_power_cut_at_any_byte_of_a_compaction_leaves_the_entries() {
    let kept = [entry(1, 1), entry(2, 7)];
    // The page, two entries and the first slot.
    let all = MOST_SLOTS * SLOT + 3 * SLOT;
    for power in 0..=all {
        let shared = Shared::new(Flash {
            power,
            done: 0x66,
            torn: vec![0x81, 0xFF, 0x00],
            ..with_two()
        });
        // An older page is there.
        let stale: Vec<u8> = shared.flash().bytes[..SECOND].to_vec();
        shared.flash().bytes[SECOND..].copy_from_slice(&stale);
        let compacted = FaultLog::open(shared.clone()).compact(kept.into_iter());
        assert_eq!(compacted.is_ok(), power == all, "{power} of {all} bytes");
        let after = Shared::new(shared.flash().clone().powered());
        assert_eq!(entries(&after.flash()), kept, "cut after {power} bytes");
        FaultLog::open(after.clone()).append(entry(3, 1)).unwrap();
        assert_eq!(entries(&after.flash()).len(), 3, "cut after {power} bytes");
    }
}

#[test]
fn of_two_pages_the_later_one_counts_when_the_sequence_wraps() {
    let shared = Shared::new(Flash::blank());
    let mut head = [0xFF; SLOT];
    head[3] = 0x7F;
    for sequence in [i32::MAX.cast_unsigned(), u32::MAX] {
        let mut digest = Crc32::default();
        digest.update(b"HFLT");
        digest.update(&sequence.to_le_bytes());
        head[..4].copy_from_slice(&sequence.to_le_bytes());
        head[4..].copy_from_slice(&digest.value().to_le_bytes());
        *shared.flash() = Flash::blank();
        shared.flash().bytes[..SLOT].copy_from_slice(&head);
        for count in 1..=3 {
            let mut log = FaultLog::open(shared.clone());
            log.compact([entry(1, count)].into_iter()).unwrap();
            assert_eq!(entries(&shared.flash()), [entry(1, count)], "{sequence}");
        }
    }
}

#[test]
fn rubbish_is_no_entry_and_a_page_of_it_is_erased() {
    let shared = Shared::new(Flash::blank());
    shared.flash().bytes[..SECOND].fill(0x5A);
    assert_eq!(FaultLog::open(shared.clone()).entries().count(), 0);
    FaultLog::open(shared.clone()).append(entry(1, 1)).unwrap();
    assert_eq!(entries(&shared.flash()), [entry(1, 1)]);
}

#[test]
fn a_full_page_takes_no_more_and_keeps_what_it_has() {
    let shared = Shared::new(Flash::blank());
    let mut log = FaultLog::open(shared.clone());
    let room = log.room();
    assert_eq!(room, MOST_SLOTS - 1);
    for _ in 0..room {
        log.append(entry(1, 1)).unwrap();
    }
    assert_eq!(log.append(entry(2, 1)), Err(LogError::Full));
    assert_eq!(entries(&shared.flash()), vec![entry(1, 1); room]);
}

#[test]
fn flash_that_fails_is_no_reason_to_write_for_ever() {
    for (protected, power) in [(true, PLENTY), (false, 0)] {
        let mut history = FaultHistory::open(Flash {
            protected,
            power,
            ..Flash::blank()
        });
        let writes = (0..10_000).filter(|_| history.update(&[1; KINDS])).count();
        assert_eq!(writes, MOST_WRITES);
    }
}

/// A tool that clears the codes again and again, and faults that come back each time, for as long as it takes to erase
/// 20 times.
#[test]
fn the_worst_bus_erases_a_page_once_in_the_stated_number_of_entries() {
    let shared = Shared::new(Flash::blank());
    let (mut entries, mut erased) = (0, 0);
    while erased < 20 {
        shared.flash().power = PLENTY;
        let mut history = FaultHistory::open(shared.clone());
        erased += usize::from(PLENTY - shared.flash().power >= MOST_SLOTS * SLOT);
        let occurrences = |round: usize| [u8::from(round.is_multiple_of(2)); KINDS];
        let writes: usize = (0..1_000)
            .map(|round| {
                (0..=KINDS)
                    .filter(|_| history.update(&occurrences(round)))
                    .count()
            })
            .sum();
        assert_eq!(writes, MOST_WRITES);
        entries += writes;
    }
    assert!(
        entries >= 19 * WRITES_PER_ERASE,
        "{entries} entries, 20 times erased"
    );
    println!("{entries} entries, {erased} pages erased");
}

/// What happens to an ECU.
#[derive(Clone, Debug)]
enum Event {
    /// A fault occurs so many times more.
    Occurs(usize, u8),
    /// The codes are cleared.
    Cleared,
    /// Time to write so many entries.
    Rest(usize),
    /// Power fails after so many bytes of what is written next; what is under way is torn.
    Cut(usize, u8, Vec<u8>),
    /// Power fails at rest, and again after so many bytes of what the start erases and writes.
    CutStart(usize, u8, Vec<u8>),
}

fn event() -> impl Strategy<Value = Event> {
    let torn = prop::collection::vec(any::<u8>(), 0..20);
    prop_oneof![
        8 => (0..KINDS, 1..4_u8).prop_map(|(kind, times)| Event::Occurs(kind, times)),
        1 => Just(Event::Cleared),
        6 => (0..20_usize).prop_map(Event::Rest),
        2 => (0..40_usize, any::<u8>(), torn.clone()).prop_map(|(bytes, done, torn)| Event::Cut(bytes, done, torn)),
        2 => (0..2_400_usize, any::<u8>(), torn).prop_map(|(bytes, done, torn)| Event::CutStart(bytes, done, torn)),
    ]
}

/// An ECU with a history.
struct Machine {
    flash: Shared,
    history: FaultHistory<Shared>,
    now: Occurrences,
}

impl Machine {
    /// The log lacks a few entries until it is compacted.
    fn new() -> Self {
        let flash = Shared::new(Flash::blank());
        let mut log = FaultLog::open(flash.clone());
        while log.room() > MOST_WRITES + 5 {
            log.append(entry(0, 0)).unwrap();
        }
        Self {
            history: FaultHistory::open(flash.clone()),
            flash,
            now: [0; KINDS],
        }
    }

    fn happens(&mut self, event: Event) {
        match event {
            Event::Occurs(kind, times) => self.now[kind] = (self.now[kind] + times).min(126),
            Event::Cleared => self.now = [0; KINDS],
            Event::Rest(entries) => {
                (0..entries).for_each(|_| {
                    self.history.update(&self.now);
                });
            }
            Event::Cut(bytes, done, torn) => {
                self.fails_after(bytes, done, torn);
                let mut cut = false;
                for _ in 0..=bytes / SLOT {
                    let before = *self.history.stored();
                    cut = self.history.update(&self.now) && *self.history.stored() == before;
                    if cut {
                        break;
                    }
                }
                self.start(usize::from(cut));
            }
            Event::CutStart(bytes, done, torn) => {
                self.fails_after(bytes, done, torn);
                let stored = *self.history.stored();
                assert_eq!(
                    FaultHistory::open(self.flash.clone()).stored(),
                    &stored,
                    "at the start that is cut"
                );
                self.start(0);
            }
        }
    }

    fn fails_after(&mut self, bytes: usize, done: u8, torn: Vec<u8>) {
        let mut flash = self.flash.flash();
        (flash.power, flash.done, flash.torn) = (bytes, done, torn);
    }

    /// Power comes back: all that was said to be stored is there, and of the rest at most `under_way` entries.
    fn start(&mut self, under_way: usize) {
        let stored = *self.history.stored();
        let powered = self.flash.flash().clone().powered();
        self.flash = Shared::new(powered);
        self.history = FaultHistory::open(self.flash.clone());
        let found = *self.history.stored();
        let differing: Vec<usize> = (0..KINDS)
            .filter(|&kind| found[kind] != stored[kind])
            .collect();
        assert!(
            differing.len() <= under_way
                && differing.iter().all(|&kind| found[kind] == self.now[kind]),
            "{found:?} after a restart, {stored:?} before, {:?} to be stored",
            self.now
        );
        self.now = found;
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(11),
        failure_persistence: None,
        ..ProptestConfig::with_cases(400)
    })]

    #[test]
    fn whatever_happens_what_was_stored_is_found_again(
        events in prop::collection::vec(event(), 1..300)
    ) {
        let mut machine = Machine::new();
        for event in events {
            machine.happens(event);
        }
        machine.start(0);
    }
}
