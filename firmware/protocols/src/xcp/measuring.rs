//! Commands that set up and run measurements.

use super::command::{code, identifier};
use super::daq::Daq;
use super::error::Refusal;
use super::event::Event;
use super::map::{EcuMemory, text_range};
use super::memory::{MemoryRange, Text};
use super::packet::{Answer, Packet, arguments, done, packet, response};

/// Lists are dynamic, with prescalers and time stamps; an overload is reported as an event.
const PROPERTIES: u8 = 0x93;
/// Times have four bytes and count microseconds.
const TIME_MODE: u8 = 0x34;
/// Unit of an event's cycle: a millisecond.
const MILLISECONDS: u8 = 6;
/// An event can sample any number of lists, in the direction to the tool.
const EVENT_FOR_MEASURING: u8 = 0x04;
const ANY_NUMBER: u8 = 0xFF;
/// Bit offset of a value that is not a single bit.
const NO_BIT: u8 = 0xFF;

/// Dispatches a command.
pub(super) fn dispatch(
    daq: &mut Daq,
    command: u8,
    rest: &[u8],
    memory: &EcuMemory<'_>,
    now_us: u32,
) -> Answer {
    match command {
        code::FREE_DAQ => {
            daq.free();
            done()
        }
        code::GET_DAQ_CLOCK => {
            let [a, b, c, d] = now_us.to_le_bytes();
            response(&[0, 0, 0, a, b, c, d])
        }
        code::GET_DAQ_PROCESSOR_INFO => {
            let events = Event::ALL.len() as u8;
            response(&[PROPERTIES, daq.lists(), 0, events, 0, 0, 0])
        }
        code::GET_DAQ_RESOLUTION_INFO => response(&[1, 7, 1, 0, TIME_MODE, 1, 0]),
        code::READ_DAQ => {
            let (address, size) = daq.read()?;
            let [a, b, c, d] = address.to_le_bytes();
            response(&[NO_BIT, size, 0, a, b, c, d])
        }
        _ => with_arguments(daq, command, rest, memory),
    }
}

fn with_arguments(daq: &mut Daq, command: u8, rest: &[u8], memory: &EcuMemory<'_>) -> Answer {
    match (command, rest) {
        (code::ALLOC_DAQ, &[_, a, b, ..]) => daq.allocate_lists(u16::from_le_bytes([a, b]))?,
        (code::ALLOC_ODT, &[_, a, b, count, ..]) => {
            daq.allocate_tables(u16::from_le_bytes([a, b]), count)?;
        }
        (code::ALLOC_ODT_ENTRY, &[_, a, b, table, count, ..]) => {
            daq.allocate_entries(u16::from_le_bytes([a, b]), table, count)?;
        }
        (code::SET_DAQ_PTR, &[_, a, b, table, entry, ..]) => {
            daq.point_to(u16::from_le_bytes([a, b]), table, entry)?;
        }
        (code::WRITE_DAQ, &[NO_BIT, size, 0, a, b, c, d, ..]) => {
            daq.write(u32::from_le_bytes([a, b, c, d]), size, memory)?;
        }
        (code::WRITE_DAQ, [_, _, _, _, _, _, _, ..]) => return Err(Refusal::OutOfRange),
        (code::SET_DAQ_LIST_MODE, &[mode, a, b, c, d, prescaler, ..]) => {
            let (list, event) = (u16::from_le_bytes([a, b]), u16::from_le_bytes([c, d]));
            daq.set_mode(list, mode, event, prescaler)?;
        }
        (code::GET_DAQ_LIST_MODE, &[_, a, b, ..]) => {
            let (mode, event, prescaler) = daq.mode(u16::from_le_bytes([a, b]))?;
            return response(&[mode, 0, 0, event, 0, prescaler, 0]);
        }
        (code::START_STOP_DAQ_LIST, &[mode, a, b, ..]) => {
            return response(&[daq.start_stop(u16::from_le_bytes([a, b]), mode)?]);
        }
        (code::START_STOP_SYNCH, &[mode, ..]) => daq.start_stop_selected(mode)?,
        // Known command, too short.
        (
            code::ALLOC_ODT_ENTRY..=code::GET_DAQ_EVENT_INFO
            | code::START_STOP_SYNCH..=code::SET_DAQ_PTR,
            _,
        ) => return Err(Refusal::Syntax),
        _ => return Err(Refusal::UnknownCommand),
    }
    done()
}

/// GET_DAQ_EVENT_INFO: properties of an event, and address of its name.
pub(super) fn event_info(rest: &[u8]) -> Result<(MemoryRange, Packet), Refusal> {
    let [_, a, b] = arguments(rest)?;
    let event = Event::from_number(u16::from_le_bytes([a, b])).ok_or(Refusal::OutOfRange)?;
    let name = text_range(Text::Event(event));
    let info = [
        EVENT_FOR_MEASURING,
        ANY_NUMBER,
        name.length,
        event.period_ms(),
        MILLISECONDS,
        0,
    ];
    Ok((name, packet(identifier::RESPONSE, &info)))
}
