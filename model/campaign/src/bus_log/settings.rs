//! `[can]` in `campaign.toml`: the signals that are taken from a bus.
//!
//! ```toml
//! [can]                                     # optional for logs of the project's ECU
//! dbc = "rig.dbc"                           # description of the bus
//! channel = "can0"                          # bus, if the log has several
//! source = 128                              # source address, if several nodes send the same message (J1939)
//! identifiers = "j1939"                     # those of 29 bits are groups, from any source address; "exact" by default
//! clock = "SampleTime"                      # signal with a message's sampling time, if it has one
//!
//! [can.signals]
//! lift_current_a = "HitchMotion.LiftCurrent"
//! ```

use std::path::Path;

use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;
use hitch_input::toml_reader::TomlTable;
use hitch_plant::Channel;

use crate::bus_log::description::{Description, Fault};
use crate::bus_log::listener::{Listener, Message, Sampled};
use crate::folder::file_in;
use crate::recorded::CampaignError;
use crate::run_columns::{COLUMNS, Column, LIFT, LOWER, TIME, column};

/// The signals of the project's ECU.
const OF_ECU: [(&str, &str); 5] = [
    (LIFT, "HitchMotion.LiftCurrent"),
    (LOWER, "HitchMotion.LowerCurrent"),
    (Channel::RockerAngle.key(), "HitchMotion.RockerAngle"),
    (
        Channel::CylinderPressure.key(),
        "HitchPressures.CylinderPressure",
    ),
    (Channel::PumpPressure.key(), "HitchPressures.PumpPressure"),
];
/// Default name of the clock signal.
const CLOCK: &str = "SampleTime";

/// The signals that are taken from a bus, and their senders.
#[derive(Debug, Clone)]
pub struct BusSettings {
    /// The bus, as named in the log; `None` for any.
    channel: Option<String>,
    /// The source address; `None` for any.
    address: Option<u8>,
    /// The messages with their signals.
    messages: Vec<Message>,
    is_of_ecu: bool,
}

impl Default for BusSettings {
    /// The settings for the project's ECU.
    fn default() -> Self {
        Self::of_ecu(CLOCK)
    }
}

impl BusSettings {
    fn of_ecu(clock: &str) -> Self {
        let mut settings = Self {
            channel: None,
            address: None,
            messages: Vec::new(),
            is_of_ecu: true,
        };
        let ecu = Description::of_ecu();
        for (name, path) in OF_ECU {
            let taken = column(name).map(|column| settings.take(&ecu, column, path, clock));
            let known = taken.is_some_and(|taken| taken.is_ok());
            assert!(known, "a test reads the project's own description");
        }
        settings
    }

    /// Reads `[can]` of a campaign in the folder `dir`.
    ///
    /// # Errors
    /// The first fault, with file, line and column.
    pub fn read(dir: &Path, top: &TomlTable<'_>) -> Result<Self, CampaignError> {
        let Some(table) = top.table("can")? else {
            return Ok(Self::default());
        };
        table.only(&[
            "dbc",
            "channel",
            "source",
            "identifiers",
            "clock",
            "signals",
        ])?;
        let own = match table.text("dbc")? {
            Some(_) => Some(SourceFile::read_any(&file_in(dir, &table, "dbc")?)?),
            None => None,
        };
        let signals = table.table("signals")?;
        if own.is_some() && signals.is_none() {
            let hint =
                "assign the columns under [can.signals], as in lift_current_a = \"Message.Signal\"";
            return Err(table.error("[can] has a dbc but no signals", hint));
        }
        let is_j1939 = match table.text("identifiers")? {
            None | Some("exact") => false,
            Some("j1939") => true,
            Some(other) => {
                let what = format!("identifiers {} are not known", quote(other));
                return Err(table.error_at("identifiers", what, "use \"exact\" or \"j1939\""));
            }
        };
        let description = own.as_ref().map(Description::read).transpose()?;
        let description = description.map(|description| description.of_j1939(is_j1939));
        let clock = table.text("clock")?;
        let mut settings = Self::of_ecu(clock.unwrap_or(CLOCK));
        if description.is_some() {
            settings.messages.clear();
            settings.is_of_ecu = false;
        }
        let description = description.unwrap_or_else(Description::of_ecu);
        if let Some(signals) = signals {
            settings.take_all(&description, &signals, clock.unwrap_or(CLOCK))?;
        }
        let mut messages = settings.messages.iter();
        if let Some(clock) = clock
            && messages.all(|message| message.clock.is_none())
        {
            let what = format!(
                "no message of an assigned signal has a signal {}",
                quote(clock)
            );
            return Err(table.error_at("clock", what, "correct the name, or delete the line"));
        }
        settings.channel = table.text("channel")?.map(str::to_owned);
        settings.address = table
            .number("source", 0.0..=253.0)?
            .map(|address| address as u8);
        Ok(settings)
    }

    fn take_all(
        &mut self,
        description: &Description,
        signals: &TomlTable<'_>,
        clock: &str,
    ) -> Result<(), CampaignError> {
        let columns = || COLUMNS.iter().filter(|column| column.name != TIME);
        let known: Vec<&str> = columns().map(|column| column.name).collect();
        signals.only(&known)?;
        for column in columns() {
            let Some(path) = signals.text(column.name)? else {
                continue;
            };
            self.forget(column);
            self.take(description, column, path, clock)
                .map_err(|(what, hint)| signals.error_at(column.name, what, hint))?;
        }
        Ok(())
    }

    fn forget(&mut self, column: &Column) {
        for message in &mut self.messages {
            message
                .signals
                .retain(|sampled| sampled.column.name != column.name);
        }
        self.messages.retain(|message| !message.signals.is_empty());
    }

    /// Takes a column from the signal `path`.
    fn take(
        &mut self,
        description: &Description,
        column: &'static Column,
        path: &str,
        clock: &str,
    ) -> Result<(), Fault> {
        let Some((name, signal)) = path.split_once('.') else {
            return Err((
                format!("{} is not a signal", quote(path)),
                "write \"Message.Signal\", as the DBC names them".to_owned(),
            ));
        };
        let found = description.message(name)?;
        let sampled = Sampled {
            column,
            signal: description.signal(found, signal, column)?,
        };
        let matching = description.matching(found);
        let known = self
            .messages
            .iter_mut()
            .find(|message| message.name == name);
        match known {
            Some(message) => message.signals.push(sampled),
            None => self.messages.push(Message {
                name: name.to_owned(),
                matching,
                signals: vec![sampled],
                clock: description.clock(found, clock)?,
                node: found.transmitter.clone().unwrap_or_else(|| name.to_owned()),
            }),
        }
        Ok(())
    }

    /// A listener for all messages of these settings in a log.
    pub fn listener<'s>(&'s self, source: &'s SourceFile) -> Listener<'s> {
        Listener::new(
            source,
            &self.messages,
            self.channel.as_deref(),
            self.address,
        )
    }

    /// Display name of the signal of a column.
    pub fn signal(&self, column: &str) -> Option<&str> {
        let signals = self.messages.iter().flat_map(|message| &message.signals);
        let mut of_column = signals.filter(|sampled| sampled.column.name == column);
        of_column.next().map(|sampled| sampled.signal.name.as_str())
    }

    /// Suggested correction for a missing column.
    pub fn how_to_get(&self, column: &str) -> String {
        match (self.is_of_ecu, self.signal(column)) {
            (true, Some(_)) => {
                "the ECU sends it while bus.measured_period is above 0; for another bus \
                 name its dbc and signals under [can] in campaign.toml"
                    .to_owned()
            }
            (false, Some(_)) => "log the bus that has it, or correct the dbc".to_owned(),
            (_, None) => format!("add {column} = \"Message.Signal\" under [can.signals]"),
        }
    }
}
