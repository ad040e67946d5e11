//! Assigns columns interactively.

use std::io;
use std::io::IsTerminal as _;

use hitch_campaign::survey::{LogColumn, check_source};

use super::{Columns, Mapping, Taken, Undetermined};
use hitch_output::error::Error;
use hitch_output::text::{indented, wrapped};

/// Assigns the columns of a log. Asks if allowed, and if standard input and output are a terminal.
///
/// # Errors
/// If a required column cannot be determined without an answer, or the user stops.
pub fn agreed(
    found: &Columns,
    named: &[(String, String)],
    may_ask: bool,
) -> Result<Mapping, Error> {
    let Columns {
        heading,
        kind,
        columns,
        ..
    } = found;
    let asks = may_ask && io::stdin().is_terminal() && io::stdout().is_terminal();
    let mut named = named.to_vec();
    if asks {
        hitch_output::print(&format!("{heading} has\n{}", listed(columns)))?;
    }
    loop {
        let proposal = Mapping::propose(columns, *kind, &named);
        match &proposal {
            Ok(mapping) => hitch_output::print(&shown(found, mapping))?,
            Err(Undetermined { what, .. }) if asks => hitch_output::print(&format!("{what}\n"))?,
            Err(Undetermined { what, hint }) => {
                return Err(Error::Usage(format!("{heading}: {what}; {hint}")));
            }
        }
        if let (false, Ok(mapping)) = (asks, &proposal) {
            return Ok(mapping.clone());
        }
        match (answer(columns, proposal.is_ok())?, proposal) {
            (Answer::Take, Ok(mapping)) => return Ok(mapping),
            (Answer::Take, Err(_)) => {}
            (Answer::Change(channel, source), _) => {
                named.retain(|(known, _)| *known != channel);
                named.push((channel, source));
            }
            (Answer::Stop, _) => {
                return Err(Error::Usage(
                    "stopped by the user; no file was written".to_owned(),
                ));
            }
        }
    }
}

/// Parses the `--map` options.
///
/// # Errors
/// If a channel or a name is missing.
pub fn named(maps: &[String]) -> Result<Vec<(String, String)>, Error> {
    let fault = |map: &String| {
        Error::Usage(format!(
            "--map {map}: write it as --map CHANNEL=\"NAME:UNIT\""
        ))
    };
    maps.iter()
        .map(|map| split(map).ok_or_else(|| fault(map)))
        .collect()
}

/// `CHANNEL=NAME:UNIT`, with or without quotation marks.
fn split(map: &str) -> Option<(String, String)> {
    let (channel, source) = map.split_once('=')?;
    let source = source.trim().trim_matches('"');
    Some((channel.trim().to_owned(), source.to_owned()))
}

enum Answer {
    Take,
    Stop,
    Change(String, String),
}

/// The user's answer; asks again until it is valid.
fn answer(columns: &[LogColumn], is_complete: bool) -> Result<Answer, Error> {
    loop {
        hitch_output::print(if is_complete {
            "Enter accepts, CHANNEL=NAME:UNIT changes a line, q stops: "
        } else {
            "CHANNEL=NAME:UNIT assigns a column, q stops: "
        })?;
        let mut line = String::new();
        let read = io::stdin().read_line(&mut line);
        let read =
            read.map_err(|error| Error::Usage(format!("the answer can't be read: {error}")))?;
        match understood(line.trim(), columns) {
            _ if read == 0 => return Ok(Answer::Stop),
            Ok(Answer::Take) if !is_complete => {}
            Ok(answer) => return Ok(answer),
            Err(why) => hitch_output::print(&format!("{why}\n"))?,
        }
    }
}

/// # Errors
/// The fault of the answer.
fn understood(line: &str, columns: &[LogColumn]) -> Result<Answer, String> {
    let line = line.strip_prefix("--map").map_or(line, str::trim_start);
    if line.is_empty() {
        return Ok(Answer::Take);
    }
    if line.eq_ignore_ascii_case("q") {
        return Ok(Answer::Stop);
    }
    let Some((channel, source)) = split(line) else {
        return Err("write it as in lift_current_a=NAME:mA, or q".to_owned());
    };
    let (name, _) = check_source(&channel, &source)?;
    if columns.iter().any(|column| column.name == name) {
        Ok(Answer::Change(channel, source))
    } else {
        Err(format!("there is no column \"{name}\""))
    }
}

/// The proposal as a table.
fn shown(found: &Columns, mapping: &Mapping) -> String {
    let widths = mapping
        .taken
        .iter()
        .map(|taken| taken.source.chars().count());
    let width = widths.max().unwrap_or(0);
    let mut text = wrapped(&format!("{}:", found.heading)) + "\n";
    for taken in &mapping.taken {
        text += &line(taken, width);
    }
    let own = mapping.notes.iter().map(ToString::to_string);
    for note in found.notes.iter().cloned().chain(own) {
        text += &(indented(&note, 2) + "\n");
    }
    let is_taken = |name: &str| {
        let mut taken = mapping.taken.iter();
        taken.any(|taken| taken.source == name || taken.source.starts_with(&format!("{name}:")))
    };
    let columns = found.columns.iter().map(|column| column.name.as_str());
    let others: Vec<&str> = columns.filter(|name| !is_taken(name)).collect();
    match others.len() {
        0 => text,
        count => text + &indented(&left_out(count, &others), 2) + "\n",
    }
}

/// Most columns that are named.
const MOST_NAMED: usize = 12;

/// A sentence about the columns that are not taken.
fn left_out(count: usize, names: &[&str]) -> String {
    let what = match count {
        1 => "1 other column is ignored".to_owned(),
        _ => format!("{count} other columns are ignored"),
    };
    let named = names[..count.min(MOST_NAMED)].join(", ");
    let more = if count > MOST_NAMED { ", ..." } else { "" };
    format!("{what}: {named}{more}")
}

/// A column with its source and the reason, in several lines if it is too long.
fn line(taken: &Taken, width: usize) -> String {
    let Taken {
        channel,
        source,
        reason,
        ..
    } = taken;
    let named = format!("  {channel:<22} {source:<width$}");
    let (named_length, most) = (named.chars().count(), hitch_output::text::width());
    if named_length + 2 + reason.chars().count() <= most {
        return format!("{named}  {reason}\n");
    }
    let reason = indented(reason, 6);
    if named_length <= most {
        format!("{}\n{reason}\n", named.trim_end())
    } else {
        format!("  {channel}\n    {source}\n{reason}\n")
    }
}

/// The columns of the log, each with its unit.
fn listed(columns: &[LogColumn]) -> String {
    const MOST: usize = 60;
    let mut text = String::new();
    for column in columns.iter().take(MOST) {
        let unit = column.unit.as_deref().unwrap_or("no unit");
        text += &format!("  {}  ({unit})\n", column.name);
    }
    match columns.len().saturating_sub(MOST) {
        0 => text,
        more => text + &format!("  and {more} more\n"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn answers_are_understood_or_said_to_be_none() {
        let columns = [LogColumn {
            name: "I1".to_owned(),
            ..LogColumn::default()
        }];
        let said = |line| understood(line, &columns);
        assert!(matches!(said(""), Ok(Answer::Take)));
        assert!(matches!(said("Q"), Ok(Answer::Stop)));
        for line in ["lift_current_a=I1:mA", "--map lift_current_a=\"I1:mA\""] {
            let Ok(Answer::Change(channel, source)) = said(line) else {
                panic!("{line}");
            };
            assert_eq!((&*channel, &*source), ("lift_current_a", "I1:mA"));
        }
        for (line, expected) in [
            ("I1", "write it as in"),
            ("lift=I1:mA", "did you mean lift_current_a"),
            ("lift_current_a=I2:mA", "no column \"I2\""),
        ] {
            let why = said(line).err().unwrap_or_default();
            assert!(why.contains(expected), "{why}");
        }
    }
}
