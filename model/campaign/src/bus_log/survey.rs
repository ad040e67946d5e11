//! Lists the signals of a description that a bus log contains.

use std::collections::HashMap;

use hitch_input::source_file::SourceFile;

use crate::bus_log::description::Description;
use crate::bus_log::frame::{Frame, FrameSink, Id};
use crate::bus_log::{Format, read_frames};
use crate::contents::LogColumn;
use crate::recorded::CampaignError;
use crate::run_columns::COLUMNS;

/// The identifiers of a log, with the number of frames of each.
#[derive(Debug, Default)]
struct IdentifierCounts {
    frames: HashMap<Id, usize>,
}

impl FrameSink for IdentifierCounts {
    fn wants(&mut self, _channel: &str, id: Id) -> bool {
        *self.frames.entry(id).or_default() += 1;
        false
    }

    fn take(&mut self, _frame: &Frame<'_>) -> Result<(), CampaignError> {
        Ok(())
    }
}

/// Signals of a description in a log.
#[derive(Debug, Clone, PartialEq)]
pub struct Signals {
    /// Signals of received messages in a unit that a column of a run may have, as `Message.Signal`; without values.
    pub columns: Vec<LogColumn>,
    /// Frames of messages that the description lacks.
    pub unknown_frames: usize,
    /// Whether its frames are those of the description only as groups of J1939.
    pub is_j1939: bool,
}

/// Searches a log for the signals of a description.
///
/// # Errors
/// The log cannot be read, or contains no such signal.
pub fn signals(
    source: &SourceFile,
    format: Format,
    dbc: &SourceFile,
) -> Result<Signals, CampaignError> {
    let description = Description::read(dbc)?;
    let mut counts = IdentifierCounts::default();
    read_frames(source, format, &mut counts)?;
    let ids: Vec<Id> = counts.frames.keys().copied().collect();
    let is_j1939 = description.is_heard_by_group(&ids);
    let description = description.of_j1939(is_j1939);
    let mut columns = Vec::new();
    let mut is_heard = false;
    let mut unknown = counts.frames.clone();
    for message in description.messages() {
        let matching = description.matching(message);
        let is_it = |id: Id| matching.sender(id).is_some();
        if !counts.frames.keys().any(|id| is_it(*id)) {
            continue;
        }
        is_heard = true;
        unknown.retain(|id, _| !is_it(*id));
        for signal in &message.signals {
            let fits = |column| description.signal(message, &signal.name, column).is_ok();
            let fault = description.why_not(message, signal);
            if fault.is_some() || COLUMNS.iter().any(fits) {
                let name = format!("{}.{}", message.name, signal.name);
                columns.push(LogColumn {
                    comment: description.comment(message, &signal.name).to_owned(),
                    fault,
                    ..LogColumn::new(&name, Some(&signal.unit))
                });
            }
        }
    }
    if columns.is_empty() {
        let name = dbc.path.display();
        let (what, hint) = if !is_heard {
            (
                format!("contains no message of {name}"),
                "name the DBC of this bus",
            )
        } else {
            (
                format!("contains no signal of {name} in a unit of a run"),
                "correct the units in the DBC: A, mA, bar, kPa, deg, l/min and the like",
            )
        };
        return Err(source.error(what, hint));
    }
    Ok(Signals {
        columns,
        unknown_frames: unknown.values().sum(),
        is_j1939,
    })
}
