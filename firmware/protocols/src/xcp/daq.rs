//! Measurement lists: each is sampled with an event, and consists of tables (ODT), one for each packet.
//!
//! ```text
//! list 0 -> ODT 0 -> entry, entry, entry      packet: number of the ODT, time (first one of a list only), values
//!        -> ODT 1 -> entry, entry
//! list 1 -> ODT 2 -> entry
//! ```
//!
//! Lists, tables and entries are allocated in this order, so each is a range of the next level. A sample is sent
//! completely or not at all: if the queue has no room for all of its packets, it is dropped, and the tool gets one
//! event.

use heapless::{Deque, Vec};

use super::error::Refusal;
use super::event::Event;
use super::map::EcuMemory;
use super::packet::{MOST_BYTES, Packet, packet};

/// Maximum number of lists.
const LISTS: usize = 4;
/// Number of tables of all lists.
const TABLES: usize = 17;
/// Number of entries of all tables.
const ENTRIES: usize = 64;
/// Capacity of the packet queue.
const QUEUE: usize = 32;
/// Bytes of a packet for values; four fewer in the first one of a list with time.
const ROOM: usize = MOST_BYTES - 1;
const TIME_BYTES: usize = 4;
/// Mode of a list: with time.
const WITH_TIME: u8 = 0x10;

/// An entry: a sampled memory range.
#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    address: u32,
    /// Size; 0: not defined.
    size: u8,
}

/// A range of the next level.
#[derive(Clone, Copy, Debug, Default)]
struct Stretch {
    first: u8,
    count: u8,
}

impl Stretch {
    fn of<T>(self, all: &[T]) -> &[T] {
        let first = usize::from(self.first);
        all.get(first..first.saturating_add(usize::from(self.count)))
            .unwrap_or(&[])
    }

    /// Index of its `index`th element.
    fn place(self, index: u8) -> Option<usize> {
        (index < self.count).then(|| usize::from(self.first).saturating_add(usize::from(index)))
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Activity {
    Stopped,
    Selected,
    Running,
}

#[derive(Clone, Copy, Debug)]
struct List {
    tables: Stretch,
    event: u8,
    prescaler: u8,
    /// Events until the next sample.
    countdown: u8,
    mode: u8,
    activity: Activity,
}

/// All measurement lists.
#[derive(Clone, Debug, Default)]
pub(super) struct Daq {
    lists: Vec<List, LISTS>,
    tables: Vec<Stretch, TABLES>,
    entries: Vec<Entry, ENTRIES>,
    /// Pointer to the next entry: list, table, entry.
    pointer: Option<(u8, u8, u8)>,
    queue: Deque<Packet, QUEUE>,
    overload: Overload,
}

/// Overload state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Overload {
    #[default]
    None,
    /// The event has to be sent.
    New,
    Told,
}

impl Daq {
    /// Deletes all lists.
    pub fn free(&mut self) {
        *self = Self::default();
    }

    /// Number of lists.
    pub fn lists(&self) -> u8 {
        length(&self.lists)
    }

    /// Whether a list is running.
    pub fn is_running(&self) -> bool {
        self.lists
            .iter()
            .any(|list| list.activity == Activity::Running)
    }

    /// Allocates lists.
    pub fn allocate_lists(&mut self, count: u16) -> Result<(), Refusal> {
        self.must_rest()?;
        if !self.tables.is_empty() {
            return Err(Refusal::Sequence);
        }
        self.lists.clear();
        let list = List {
            tables: Stretch::default(),
            event: Event::Every10Ms as u8,
            prescaler: 1,
            countdown: 0,
            mode: 0,
            activity: Activity::Stopped,
        };
        self.lists
            .resize(usize::from(count), list)
            .map_err(|_| Refusal::MemoryOverflow)
    }

    /// Allocates tables of a list, in the order of the lists.
    pub fn allocate_tables(&mut self, list: u16, count: u8) -> Result<(), Refusal> {
        self.must_rest()?;
        let in_order = self.entries.is_empty() && self.tables_follow(list)?;
        let first = length(&self.tables);
        let wanted = self.tables.len().saturating_add(usize::from(count));
        let target = self.list_mut(list)?;
        if !in_order {
            return Err(Refusal::Sequence);
        }
        target.tables = Stretch { first, count };
        if self.tables.resize(wanted, Stretch::default()).is_err() {
            self.list_mut(list)?.tables = Stretch::default();
            return Err(Refusal::MemoryOverflow);
        }
        Ok(())
    }

    /// Whether no list from this one on has tables.
    fn tables_follow(&self, list: u16) -> Result<bool, Refusal> {
        let rest = self.lists.get(usize::from(list)..);
        let rest = rest.filter(|rest| !rest.is_empty());
        let rest = rest.ok_or(Refusal::OutOfRange)?;
        Ok(rest.iter().all(|list| list.tables.count == 0))
    }

    /// Allocates entries of a table, in the order of the tables.
    pub fn allocate_entries(&mut self, list: u16, table: u8, count: u8) -> Result<(), Refusal> {
        self.must_rest()?;
        let place = self.list(list)?.tables.place(table);
        let place = place.ok_or(Refusal::OutOfRange)?;
        let rest = self.tables.get(place..).unwrap_or(&[]);
        if rest.iter().any(|table| table.count > 0) {
            return Err(Refusal::Sequence);
        }
        let first = length(&self.entries);
        let wanted = self.entries.len().saturating_add(usize::from(count));
        self.entries
            .resize(wanted, Entry::default())
            .map_err(|_| Refusal::MemoryOverflow)?;
        if let Some(table) = self.tables.get_mut(place) {
            *table = Stretch { first, count };
        }
        Ok(())
    }

    /// Sets the pointer to an entry.
    pub fn point_to(&mut self, list: u16, table: u8, entry: u8) -> Result<(), Refusal> {
        let number = u8::try_from(list).map_err(|_| Refusal::OutOfRange)?;
        self.pointer = Some((number, table, entry));
        let found = self.pointed_at().map(|_| ());
        if found.is_err() {
            self.pointer = None;
        }
        found
    }

    /// The entry at the pointer.
    fn pointed_at(&self) -> Result<usize, Refusal> {
        let (list, table, entry) = self.pointer.ok_or(Refusal::Sequence)?;
        let table = self.list(list.into())?.tables.place(table);
        let table = table.and_then(|place| self.tables.get(place));
        let place = table.and_then(|table| table.place(entry));
        place.ok_or(Refusal::OutOfRange)
    }

    /// Advances the pointer.
    fn advance(&mut self) {
        if let Some((_, _, entry)) = &mut self.pointer {
            *entry = entry.saturating_add(1);
        }
    }

    /// Writes the entry at the pointer.
    pub fn write(&mut self, address: u32, size: u8, memory: &EcuMemory<'_>) -> Result<(), Refusal> {
        let place = self.pointed_at()?;
        let (list, ..) = self.pointer.ok_or(Refusal::Sequence)?;
        if self.list(list.into())?.activity == Activity::Running {
            return Err(Refusal::DaqActive);
        }
        let mut value = [0; ROOM];
        let value = value.get_mut(..usize::from(size)).filter(|_| size > 0);
        memory.read(address, value.ok_or(Refusal::OutOfRange)?)?;
        if let Some(entry) = self.entries.get_mut(place) {
            *entry = Entry { address, size };
        }
        self.advance();
        Ok(())
    }

    /// Address and size of the entry at the pointer.
    pub fn read(&mut self) -> Result<(u32, u8), Refusal> {
        let place = self.pointed_at()?;
        self.advance();
        let entry = self.entries.get(place).ok_or(Refusal::OutOfRange)?;
        Ok((entry.address, entry.size))
    }

    /// Sets event and mode of a list.
    pub fn set_mode(
        &mut self,
        list: u16,
        mode: u8,
        event: u16,
        prescaler: u8,
    ) -> Result<(), Refusal> {
        let event = Event::from_number(event).ok_or(Refusal::OutOfRange)?;
        let list = self.list_mut(list)?;
        if list.activity == Activity::Running {
            return Err(Refusal::DaqActive);
        }
        // Stimulation, packets without number, and alternating displays are not supported.
        if mode & !WITH_TIME != 0 {
            return Err(Refusal::ModeNotValid);
        }
        list.mode = mode;
        list.event = event as u8;
        list.prescaler = prescaler.max(1);
        Ok(())
    }

    /// Mode (with its state), event and prescaler of a list.
    pub fn mode(&self, list: u16) -> Result<(u8, u8, u8), Refusal> {
        const RUNNING: u8 = 0x40;
        const SELECTED: u8 = 0x01;
        let list = self.list(list)?;
        let activity = match list.activity {
            Activity::Stopped => 0,
            Activity::Selected => SELECTED,
            Activity::Running => RUNNING,
        };
        Ok((list.mode | activity, list.event, list.prescaler))
    }

    /// Stops, starts or selects a list; returns the number of its first packet.
    pub fn start_stop(&mut self, list: u16, mode: u8) -> Result<u8, Refusal> {
        let activity = match mode {
            0 => Activity::Stopped,
            1 => Activity::Running,
            2 => Activity::Selected,
            _ => return Err(Refusal::ModeNotValid),
        };
        if activity != Activity::Stopped {
            self.must_make_sense(list)?;
        }
        let list = self.list_mut(list)?;
        list.activity = activity;
        list.countdown = 0;
        Ok(list.tables.first)
    }

    /// Stops all lists (0), starts (1) or stops (2) the selected ones.
    pub fn start_stop_selected(&mut self, mode: u8) -> Result<(), Refusal> {
        for list in &mut self.lists {
            let selected = list.activity == Activity::Selected;
            list.activity = match mode {
                0 => Activity::Stopped,
                1 if selected => Activity::Running,
                2 if selected => Activity::Stopped,
                1 | 2 => list.activity,
                _ => return Err(Refusal::ModeNotValid),
            };
            list.countdown = 0;
        }
        Ok(())
    }

    /// Samples the running lists of an event.
    pub fn sample(&mut self, event: Event, memory: &EcuMemory<'_>, now_us: u32) {
        let (tables, entries) = (&self.tables, &self.entries);
        for list in &mut self.lists {
            if list.activity != Activity::Running || list.event != event as u8 {
                continue;
            }
            if list.countdown > 0 {
                list.countdown = list.countdown.saturating_sub(1);
                continue;
            }
            list.countdown = list.prescaler.saturating_sub(1);
            let room = QUEUE.saturating_sub(self.queue.len());
            if room < usize::from(list.tables.count) {
                if self.overload == Overload::None {
                    self.overload = Overload::New;
                }
                continue;
            }
            let time = now_us.to_le_bytes();
            let mut time = (list.mode & WITH_TIME != 0).then_some(time);
            for (number, table) in (list.tables.first..=u8::MAX).zip(list.tables.of(tables)) {
                let mut sample = packet(number, time.take().as_ref().map_or(&[], |time| time));
                for entry in table.of(entries) {
                    append(&mut sample, entry, memory);
                }
                let _ = self.queue.push_back(sample);
            }
        }
    }

    /// The next packet. An overload ends when all are sent.
    pub fn next_packet(&mut self) -> Option<Packet> {
        let next = self.queue.pop_front();
        if next.is_none() && self.overload == Overload::Told {
            self.overload = Overload::None;
        }
        next
    }

    /// True once after samples were first dropped.
    pub fn take_overload(&mut self) -> bool {
        let new = self.overload == Overload::New;
        if new {
            self.overload = Overload::Told;
        }
        new
    }

    fn must_rest(&self) -> Result<(), Refusal> {
        if self.is_running() {
            Err(Refusal::DaqActive)
        } else {
            Ok(())
        }
    }

    /// A list can be started if it has tables, its entries are written, and each table fits into a packet.
    fn must_make_sense(&self, number: u16) -> Result<(), Refusal> {
        let list = self.list(number)?;
        let mut room = if list.mode & WITH_TIME != 0 {
            ROOM - TIME_BYTES
        } else {
            ROOM
        };
        let tables = list.tables.of(&self.tables);
        for table in tables {
            let entries = table.of(&self.entries);
            let sizes = entries.iter().map(|entry| usize::from(entry.size));
            let bytes = sizes.fold(0, usize::saturating_add);
            if bytes > room || entries.iter().any(|entry| entry.size == 0) {
                return Err(Refusal::DaqConfiguration);
            }
            room = ROOM;
        }
        if tables.is_empty() {
            return Err(Refusal::DaqConfiguration);
        }
        Ok(())
    }

    fn list(&self, number: u16) -> Result<&List, Refusal> {
        let list = self.lists.get(usize::from(number));
        list.ok_or(Refusal::OutOfRange)
    }

    fn list_mut(&mut self, number: u16) -> Result<&mut List, Refusal> {
        let list = self.lists.get_mut(usize::from(number));
        list.ok_or(Refusal::OutOfRange)
    }
}

/// Appends the value of an entry to a packet. An unreadable value is zero, so that the positions of the others stay.
fn append(sample: &mut Packet, entry: &Entry, memory: &EcuMemory<'_>) {
    let mut value = [0; ROOM];
    if let Some(value) = value.get_mut(..usize::from(entry.size)) {
        let _ = memory.read(entry.address, value);
        for byte in value {
            let _ = sample.push(*byte);
        }
    }
}

/// Number of elements; capacities are far below 256.
fn length<T>(all: &[T]) -> u8 {
    u8::try_from(all.len()).unwrap_or(u8::MAX)
}
