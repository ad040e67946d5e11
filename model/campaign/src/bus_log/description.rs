//! The signals of a bus, as described by a DBC.

use std::ops::RangeInclusive;

use can_dbc::{
    AttributeValue, ByteOrder, Dbc, DbcError, Message, MessageId, MultiplexIndicator, NumericValue,
    SignalExtendedValueType, ValueType,
};
use hitch_input::input_error::{InputError, Position, quote};
use hitch_input::naming::offer_names;
use hitch_input::source_file::SourceFile;

use crate::bus_log::frame::{Id, MOST_BYTES, group};
use crate::bus_log::signal::{Bits, Kind, Selector, Signal};
use crate::recorded::CampaignError;
use crate::run_columns::{COLUMNS, Column, TIMES};
use crate::scale::Scale;

/// The description of the project's ECU.
const OF_ECU: &str = include_str!("../../../../firmware/hitch.dbc");

/// Shortest period of a clock that can be distinguished from the delays of a logger, s.
const SHORTEST_ROUND_S: f64 = 2.0;

/// Fault description and suggested correction.
pub type Fault = (String, String);

/// Selection of the frames of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Match {
    /// Frames with this identifier.
    Identifier(Id),
    /// Frames of this parameter group from any sender (J1939).
    Group(u32),
}

/// A description.
#[derive(Debug, Clone)]
pub struct Description {
    dbc: Dbc,
    /// Whether all messages with 29 bits are those of J1939, even without an attribute.
    is_j1939: bool,
}

impl Description {
    /// Reads a DBC.
    ///
    /// # Errors
    /// The text is not a DBC, with the position.
    pub fn read(source: &SourceFile) -> Result<Self, CampaignError> {
        let dbc = Dbc::try_from(source.text.as_str()).map_err(|error| not_dbc(source, &error))?;
        let is_j1939 = false;
        Ok(Self { dbc, is_j1939 })
    }

    /// The same description, of a bus of J1939 if `is_j1939`.
    pub fn of_j1939(self, is_j1939: bool) -> Self {
        Self { is_j1939, ..self }
    }

    /// Whether frames of a log come only by the groups of messages: from other addresses, or with other priorities. A
    /// group of several messages does not count.
    pub fn is_heard_by_group(&self, ids: &[Id]) -> bool {
        let exact: Vec<Match> = self.messages().iter().map(|m| self.matching(m)).collect();
        let is_known = |id: &Id| exact.iter().any(|matching| matching.sender(*id).is_some());
        let others: Vec<u32> = ids
            .iter()
            .filter(|id| !is_known(id))
            .filter_map(|id| id.group())
            .collect();
        let raw = |matching: &Match| match matching {
            Match::Identifier(id) if !ids.contains(id) => id.group(),
            _ => None,
        };
        let groups: Vec<u32> = exact.iter().filter_map(raw).collect();
        let is_only = |group: &u32| groups.iter().filter(|other| *other == group).count() == 1;
        groups
            .iter()
            .any(|group| is_only(group) && others.contains(group))
    }

    /// The description of the project's ECU.
    pub fn of_ecu() -> Self {
        let dbc = Dbc::try_from(OF_ECU).expect("a test reads the project's own description");
        let is_j1939 = false;
        Self { dbc, is_j1939 }
    }

    /// The message with this name.
    pub fn message(&self, name: &str) -> Result<&Message, Fault> {
        let mut messages = self.messages().iter();
        let found = messages.find(|message| message.name == name);
        found.ok_or_else(|| {
            let messages = self.messages().iter();
            let names: Vec<&str> = messages.map(|message| message.name.as_str()).collect();
            (
                format!("the DBC has no message {}", quote(name)),
                offer_names(name, &names),
            )
        })
    }

    /// All messages.
    pub fn messages(&self) -> &[Message] {
        &self.dbc.messages
    }

    /// The comment of a signal; empty without one.
    pub fn comment(&self, message: &Message, signal: &str) -> &str {
        let comment = self.dbc.signal_comment(message.id, signal);
        comment.unwrap_or_default()
    }

    /// The selection of the frames of a message.
    pub fn matching(&self, message: &Message) -> Match {
        match message.id {
            MessageId::Standard(raw) => Match::Identifier(Id::Standard(raw.into())),
            MessageId::Extended(raw) if self.is_j1939 || self.is_marked(message) => {
                Match::Group(group(raw))
            }
            MessageId::Extended(raw) => Match::Identifier(Id::Extended(raw)),
        }
    }

    /// The attribute by which Vector's tools mark messages of J1939.
    fn is_marked(&self, message: &Message) -> bool {
        const NUMBER: u64 = 3;
        match self
            .dbc
            .resolved_message_attribute(message.id, "VFrameFormat")
        {
            Some(AttributeValue::Uint(number)) => *number == NUMBER,
            Some(AttributeValue::String(name)) => name == "J1939PG",
            _ => false,
        }
    }

    /// A signal of a message, in the unit of `column`.
    pub fn signal(&self, message: &Message, name: &str, column: &Column) -> Result<Signal, Fault> {
        let found = message.signals.iter().find(|signal| signal.name == name);
        let signal = found.ok_or_else(|| {
            let signals = message.signals.iter();
            let names: Vec<&str> = signals.map(|signal| signal.name.as_str()).collect();
            (
                format!("message {} has no signal {}", message.name, quote(name)),
                offer_names(name, &names),
            )
        })?;
        let name = format!("{}.{}", message.name, signal.name);
        let (factor, offset) = conversion(&name, &signal.unit, column)?;
        let kind = self.kind(message, signal);
        let is_whole = match kind {
            Kind::Float => signal.size == 32,
            Kind::Double => signal.size == 64,
            Kind::Unsigned | Kind::Signed => true,
        };
        if !is_whole {
            return Err(wrong(
                &name,
                "is a floating-point number of an unsupported size",
            ));
        }
        Ok(Signal {
            bits: bits(&name, signal)?,
            kind,
            factor: signal.factor * factor,
            offset: signal.offset * factor + offset,
            has_reserved_values: matches!(self.matching(message), Match::Group(_)),
            selected_by: self.selectors(message, signal, &name)?,
            name,
        })
    }

    /// The signal of a message with its sampling time, s, if it has one, and the period of its wrap-around: one step
    /// more than its largest value in the description.
    pub fn clock(&self, message: &Message, name: &str) -> Result<Option<(Signal, f64)>, Fault> {
        let Some(found) = message.signals.iter().find(|signal| signal.name == name) else {
            return Ok(None);
        };
        let mut signal = self.signal(message, name, &TIMES)?;
        // The signal uses its full range.
        signal.has_reserved_values = false;
        let range = number(found.max) - number(found.min);
        let period_s = (range + found.factor) * (signal.factor / found.factor);
        let is_a_clock = period_s.is_finite() && period_s > SHORTEST_ROUND_S;
        if is_a_clock {
            Ok(Some((signal, period_s)))
        } else {
            Err((
                format!(
                    "signal {} wraps around within {SHORTEST_ROUND_S} s",
                    signal.name
                ),
                "set its range in the dbc, or use another clock".to_owned(),
            ))
        }
    }

    /// Why a signal in a unit of a run cannot be decoded; `None` for a signal of another quantity.
    pub fn why_not(&self, message: &Message, signal: &can_dbc::Signal) -> Option<String> {
        let mut columns = COLUMNS.iter();
        let column = columns.find(|column| conversion("", &signal.unit, column).is_ok())?;
        let fault = self.signal(message, &signal.name, column).err()?;
        Some(fault.0)
    }

    fn kind(&self, message: &Message, signal: &can_dbc::Signal) -> Kind {
        let extended = self
            .dbc
            .extended_value_type_for_signal(message.id, &signal.name);
        match (extended, signal.value_type) {
            (Some(SignalExtendedValueType::IEEEfloat32Bit), _) => Kind::Float,
            (Some(SignalExtendedValueType::IEEEdouble64bit), _) => Kind::Double,
            (_, ValueType::Signed) => Kind::Signed,
            (_, ValueType::Unsigned) => Kind::Unsigned,
        }
    }

    /// The multiplexers that select a signal, each of which may be selected by another one.
    fn selectors(
        &self,
        message: &Message,
        signal: &can_dbc::Signal,
        name: &str,
    ) -> Result<Vec<Selector>, Fault> {
        let mut selectors = Vec::new();
        let mut selected = signal;
        while let Some((switch, values)) = self.selection(message, selected) {
            let is_switch = |other: &&can_dbc::Signal| match switch {
                Some(name) => other.name == name,
                None => other.multiplexer_indicator == MultiplexIndicator::Multiplexor,
            };
            let found = message.signals.iter().find(is_switch);
            selected = found.ok_or_else(|| wrong(name, "is multiplexed without a multiplexor"))?;
            let bits = bits(name, selected)?;
            selectors.push(Selector { bits, values });
            if selectors.len() > message.signals.len() {
                return Err(wrong(name, "has multiplexors that select each other"));
            }
        }
        Ok(selectors)
    }

    /// The name of the multiplexor of a signal, `None` for that of the message, and its values that select the signal: of
    /// `SG_MUL_VAL_`, else of the signal.
    fn selection(
        &self,
        message: &Message,
        signal: &can_dbc::Signal,
    ) -> Option<(Option<&str>, Vec<RangeInclusive<u64>>)> {
        let mut extended = self.dbc.extended_multiplex.iter();
        let ranges = extended
            .find(|ranges| ranges.message_id == message.id && ranges.signal_name == signal.name);
        if let Some(ranges) = ranges {
            let values = ranges.mappings.iter();
            let values = values.map(|range| range.min_value..=range.max_value);
            let switch = &ranges.multiplexor_signal_name;
            return Some((Some(switch), values.collect()));
        }
        match signal.multiplexer_indicator {
            MultiplexIndicator::MultiplexedSignal(value)
            | MultiplexIndicator::MultiplexorAndMultiplexedSignal(value) => {
                Some((None, vec![value..=value]))
            }
            MultiplexIndicator::Plain | MultiplexIndicator::Multiplexor => None,
        }
    }
}

fn number(value: NumericValue) -> f64 {
    match value {
        NumericValue::Uint(value) => value as f64,
        NumericValue::Int(value) => value as f64,
        NumericValue::Double(value) => value,
    }
}

fn bits(name: &str, signal: &can_dbc::Signal) -> Result<Bits, Fault> {
    let fits = (1..=64).contains(&signal.size) && signal.start_bit < 8 * MOST_BYTES as u64;
    if !fits {
        return Err(wrong(name, "has bits beyond the length of a frame"));
    }
    Ok(Bits {
        start: signal.start_bit as usize,
        size: signal.size as usize,
        is_big_endian: signal.byte_order == ByteOrder::BigEndian,
    })
}

/// Factor and offset from the signal's unit to the column's.
fn conversion(name: &str, unit: &str, column: &Column) -> Result<(f64, f64), Fault> {
    let what = match Scale::of(unit, column) {
        Ok(Scale::Line { factor, offset }) => return Ok((factor, offset)),
        _ if unit.trim().is_empty() => "has no unit".to_owned(),
        _ => format!("is in {}", quote(unit)),
    };
    let hint = format!(
        "a unit like {} is required: correct it in the DBC",
        column.unit
    );
    Err((format!("signal {name} {what}"), hint))
}

fn wrong(name: &str, what: &str) -> Fault {
    (
        format!("signal {name} {what}"),
        "such signals are not supported: choose another one".to_owned(),
    )
}

fn not_dbc(source: &SourceFile, error: &DbcError) -> InputError {
    let said = error.to_string();
    let hint = "export it again as DBC";
    // Position of the syntax error: `--> LINE:COLUMN`, and a last line with the expected tokens.
    let place = said.lines().find_map(|line| {
        let (line, column) = line.trim().strip_prefix("--> ")?.split_once(':')?;
        Some(Position {
            line: line.parse().ok()?,
            column: column.parse().ok()?,
        })
    });
    match place {
        Some(place) => InputError::at(&source.path, place, "this is not DBC", hint),
        None => source.error(format!("is not DBC: {said}"), hint),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run_columns::{LIFT, column};

    #[test]
    fn the_project_s_own_description_is_read() {
        let ecu = Description::of_ecu();
        let message = ecu.message("HitchMotion").unwrap();
        assert_eq!(ecu.matching(message), Match::Group(0xFF45));
        let angle = ecu
            .signal(message, "RockerAngle", column("rocker_angle_deg").unwrap())
            .unwrap();
        let data = [0, 0, 0, 0, 0x55, 0x71, 0, 0];
        let value_deg = angle.value(&data).unwrap().unwrap();
        assert!((value_deg - 90.13).abs() < 1e-9, "{value_deg}");
    }

    #[test]
    fn units_are_converted_or_refused() {
        let of = |unit, wanted| conversion("M.S", unit, column(wanted).unwrap());
        assert_eq!(of("mA", LIFT), Ok((1e-3, 0.0)));
        for unit in ["", "bar", "%", "parsec"] {
            assert!(of(unit, LIFT).is_err(), "{unit}");
        }
    }

    #[test]
    fn groups_are_without_destination() {
        assert_eq!(group(0x18FF_4580), 0xFF45);
        assert_eq!(group(0x18EF_80F9), 0xEF00);
    }
}
