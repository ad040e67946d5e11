//! Extracts the wanted signals from the frames of a log.

use hitch_input::input_error::quote;
use hitch_input::source_file::SourceFile;

use crate::bus_log::clock::Clock;
use crate::bus_log::description::Match;
use crate::bus_log::frame::{Frame, FrameSink, Id, group};
use crate::bus_log::signal::Signal;
use crate::recorded::CampaignError;
use crate::run_columns::Column;
use crate::series::Series;

/// A column and its signal.
#[derive(Debug, Clone)]
pub struct Sampled {
    /// The column.
    pub column: &'static Column,
    /// The signal, in the column's unit.
    pub signal: Signal,
}

/// A message that is received.
#[derive(Debug, Clone)]
pub struct Message {
    /// Its name in the description.
    pub name: String,
    /// The selection of its frames.
    pub matching: Match,
    /// The columns taken from it; at least one.
    pub signals: Vec<Sampled>,
    /// Its sampling time, s, and the period of its wrap-around.
    pub clock: Option<(Signal, f64)>,
    /// The node of that clock.
    pub node: String,
}

/// The sender of a message.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Sender {
    channel: String,
    address: Option<u8>,
}

/// A message, its sender, and the received series.
#[derive(Debug)]
struct Received<'s> {
    message: &'s Message,
    sender: Option<Sender>,
    series: Vec<Series>,
}

/// The listener.
#[derive(Debug)]
pub struct Listener<'s> {
    source: &'s SourceFile,
    channel: Option<&'s str>,
    address: Option<u8>,
    heard: Vec<Received<'s>>,
    clocks: Vec<(&'s str, Clock)>,
    /// Time of the first wanted frame, s.
    first_s: Option<f64>,
}

impl<'s> Listener<'s> {
    /// A listener for some messages of a log; a channel or a source address restricts it.
    pub fn new(
        source: &'s SourceFile,
        messages: &'s [Message],
        channel: Option<&'s str>,
        address: Option<u8>,
    ) -> Self {
        let heard = messages.iter().map(|message| Received {
            message,
            sender: None,
            series: vec![Series::default(); message.signals.len()],
        });
        Self {
            source,
            channel,
            address,
            heard: heard.collect(),
            clocks: Vec::new(),
            first_s: None,
        }
    }

    /// Time stamp of time 0, s.
    pub fn origin_s(&self) -> f64 {
        self.first_s.unwrap_or_default()
    }

    /// The received series of each column.
    pub fn series(&self) -> impl Iterator<Item = (&'static Column, &Series)> {
        self.heard.iter().flat_map(|heard| {
            let columns = heard.message.signals.iter().map(|sampled| sampled.column);
            columns.zip(&heard.series)
        })
    }
}

impl FrameSink for Listener<'_> {
    fn wants(&mut self, channel: &str, id: Id) -> bool {
        let is_there = self.channel.is_none_or(|wanted| wanted == channel);
        let mut messages = self.heard.iter().map(|heard| heard.message.matching);
        is_there && messages.any(|matching| is_from(matching.sender(id), self.address))
    }

    /// Times start at the first wanted frame. The same message from two nodes is an error.
    fn take(&mut self, frame: &Frame<'_>) -> Result<(), CampaignError> {
        let source = self.source;
        let logged_s = frame.time_s - *self.first_s.get_or_insert(frame.time_s);
        let sender = Sender {
            channel: frame.channel.to_owned(),
            address: None,
        };
        for heard in &mut self.heard {
            let found = heard.message.matching.sender(frame.id);
            if !is_from(found, self.address) {
                continue;
            }
            let sender = Sender {
                address: found.flatten(),
                ..sender.clone()
            };
            heard
                .is_from(sender)
                .map_err(|(what, hint)| source.error_at(frame.byte, what, hint))?;
            let time_s = sampled_s(&mut self.clocks, heard.message, frame, logged_s);
            let time_s = time_s.map_err(|(what, hint)| source.error_at(frame.byte, what, hint))?;
            heard.sample(source, frame, time_s)?;
        }
        Ok(())
    }
}

/// Whether a frame comes from the wanted source address, if one is given.
fn is_from(found: Option<Option<u8>>, wanted: Option<u8>) -> bool {
    found.is_some_and(|address| address.is_none() || wanted.is_none() || address == wanted)
}

/// Sampling time of a frame by its sender's clock, if it has one, else its time stamp.
fn sampled_s<'s>(
    clocks: &mut Vec<(&'s str, Clock)>,
    message: &'s Message,
    frame: &Frame<'_>,
    logged_s: f64,
) -> Result<f64, (String, String)> {
    let Some((clock, period_s)) = &message.clock else {
        return Ok(logged_s);
    };
    let shown_s = value(clock, frame)?.filter(|shown_s| shown_s.is_finite());
    let Some(shown_s) = shown_s else {
        return Ok(logged_s);
    };
    let known = clocks.iter().position(|(node, _)| *node == message.node);
    let index = known.unwrap_or_else(|| {
        clocks.push((&message.node, Clock::default()));
        clocks.len() - 1
    });
    clocks[index]
        .1
        .time_s(logged_s, shown_s, *period_s)
        .ok_or_else(|| {
            (
                format!(
                    "{} jumps: its node was switched off, or frames are missing",
                    clock.name
                ),
                "cut the log here and make two runs of it".to_owned(),
            )
        })
}

fn value(signal: &Signal, frame: &Frame<'_>) -> Result<Option<f64>, (String, String)> {
    signal.value(frame.data).map_err(|_| {
        let what = format!(
            "the frame has {} bytes, too few for {}",
            frame.data.len(),
            signal.name
        );
        (
            what,
            "the dbc describes a different message: correct it".to_owned(),
        )
    })
}

impl Received<'_> {
    /// The same message from two nodes means two machines.
    fn is_from(&mut self, sender: Sender) -> Result<(), (String, String)> {
        let known = self.sender.get_or_insert_with(|| sender.clone());
        if *known == sender {
            return Ok(());
        }
        let name = &self.message.name;
        Err(if known.channel == sender.channel {
            let [one, other] = [&*known, &sender].map(|sender| sender.address.unwrap_or_default());
            (
                format!("{name} comes from addresses {one} and {other}"),
                format!("write source = {one} under [can] in campaign.toml"),
            )
        } else {
            let [one, other] = [&*known, &sender].map(|sender| quote(&sender.channel));
            (
                format!("{name} comes on {one} and on {other}"),
                format!("write channel = {one} under [can] in campaign.toml"),
            )
        })
    }

    fn sample(
        &mut self,
        source: &SourceFile,
        frame: &Frame<'_>,
        time_s: f64,
    ) -> Result<(), CampaignError> {
        for (sampled, series) in self.message.signals.iter().zip(&mut self.series) {
            let fault = |(what, hint): (String, String)| source.error_at(frame.byte, what, hint);
            let Some(value) = value(&sampled.signal, frame).map_err(fault)? else {
                continue;
            };
            let column = sampled.column;
            if !value.is_nan() {
                column.checked(value).map_err(|(_, range)| {
                    let signal = &sampled.signal.name;
                    let what = format!("{value} of {signal} cannot be {}", column.name);
                    fault((what, format!("{range}: check scale and unit in the dbc")))
                })?;
            }
            series.push(time_s, value, frame.byte);
        }
        Ok(())
    }
}

impl Match {
    /// The source address, if the identifier is that of the message; only J1939 has addresses.
    pub fn sender(self, id: Id) -> Option<Option<u8>> {
        match (self, id) {
            (Self::Identifier(known), id) => (known == id).then_some(None),
            (Self::Group(known), Id::Extended(raw)) => {
                (group(raw) == known).then_some(Some(raw.to_le_bytes()[0]))
            }
            (Self::Group(_), Id::Standard(_)) => None,
        }
    }
}
