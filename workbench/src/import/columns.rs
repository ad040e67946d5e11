//! Assigns a log's columns to a run's columns: by the user's mapping, else by names, units and values.

use hitch_campaign::survey::{LogColumn, TIMES, check_source, fits, run_columns};

use super::words::{CHANNELS, Words, is_time};

/// Largest plausible angle in radians.
const MOST_RAD: f64 = 3.2;
/// Angles within this limit are probably in radians: a working hitch exceeds so many degrees.
const SURELY_RAD: f64 = MOST_RAD;
/// Larger values of a current are in milliampere.
const MOST_A: f64 = 20.0;
/// Larger values of a pressure are not in bar.
const MOST_BAR: f64 = 400.0;

/// Kind of a log.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A table with a column of times.
    Table,
    /// Channels with their own times.
    Channels,
    /// Signals of a bus, with units from its description.
    Signals,
}

/// A column of a run, its source, and the reason for the choice.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Taken {
    /// The run's column.
    pub channel: &'static str,
    /// Name and unit, as in `[columns]`.
    pub source: String,
    /// Reason.
    pub reason: String,
}

/// Assignment for a log.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Mapping {
    /// In the order of a run's columns.
    pub taken: Vec<Taken>,
}

/// A column that could not be determined.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Untold {
    /// Description.
    pub what: String,
    /// Suggested correction.
    pub mend: String,
}

/// A candidate column with its score.
struct Candidate<'c> {
    column: &'c LogColumn,
    score: i32,
    /// Evidence.
    by: &'static str,
}

impl Mapping {
    /// Proposes an assignment. `named` contains the user's mapping: the run's column, and its source.
    ///
    /// # Errors
    /// If a required column is missing; with a suggested correction.
    pub fn propose(
        columns: &[LogColumn],
        kind: Kind,
        named: &[(String, String)],
    ) -> Result<Self, Untold> {
        let mut mapping = Self::default();
        let mut used: Vec<String> = Vec::new();
        for (channel, source) in named {
            let (name, _) = check_source(channel, source).map_err(|what| Untold {
                what: format!("--map {channel}={source}: {what}"),
                mend: "write it as --map CHANNEL=\"NAME:UNIT\"".to_owned(),
            })?;
            let known = run_columns().find(|(known, _)| known == channel);
            if let Some((channel, _)) = known {
                used.push(name);
                mapping.take(channel, source.clone(), "given by --map".to_owned());
            }
        }
        if kind == Kind::Table && !mapping.has(TIMES) {
            let (column, source, reason) = time(columns)
                .ok_or_else(|| missing(TIMES, "times have to rise from row to row", columns))?;
            used.push(column.name.clone());
            mapping.take(TIMES, source, reason);
        }
        for words in &CHANNELS {
            if mapping.has(words.channel) {
                continue;
            }
            let free = columns.iter().filter(|column| !used.contains(&column.name));
            if let Some((column, source, reason)) = proposal(words, free)? {
                used.push(column.name.clone());
                let source = match kind {
                    Kind::Signals => column.name.clone(),
                    Kind::Table | Kind::Channels => source,
                };
                mapping.take(words.channel, source, reason);
            }
        }
        mapping.check(columns)?;
        mapping
            .taken
            .sort_by_key(|taken| run_columns().position(|(name, _)| name == taken.channel));
        Ok(mapping)
    }

    fn take(&mut self, channel: &'static str, source: String, reason: String) {
        self.taken.push(Taken {
            channel,
            source,
            reason,
        });
    }

    fn has(&self, channel: &str) -> bool {
        self.taken.iter().any(|taken| taken.channel == channel)
    }

    fn check(&self, columns: &[LogColumn]) -> Result<(), Untold> {
        for channel in ["lift_current_a", "lower_current_a"] {
            if !self.has(channel) {
                return Err(missing(channel, "it is an input of the model", columns));
            }
        }
        let measured = [
            "rocker_angle_deg",
            "cylinder_pressure_bar",
            "pump_pressure_bar",
            "flow_lpm",
        ];
        match measured.iter().any(|channel| self.has(channel)) {
            true => Ok(()),
            false => Err(missing(measured[0], "a run needs a measurement", columns)),
        }
    }
}

fn missing(channel: &str, why: &str, columns: &[LogColumn]) -> Untold {
    const MOST: usize = 16;
    let names: Vec<&str> = columns
        .iter()
        .take(MOST)
        .map(|column| column.name.as_str())
        .collect();
    let more = if columns.len() > MOST { ", ..." } else { "" };
    Untold {
        what: format!("no column was recognised as {channel}; {why}"),
        mend: format!(
            "assign it with --map {channel}=\"NAME:UNIT\"; columns: {}{more}",
            names.join(", ")
        ),
    }
}

/// The column of the times, as in `[columns]`.
fn time(columns: &[LogColumn]) -> Option<(&LogColumn, String, String)> {
    let rises = |column: &&LogColumn| {
        let known: Vec<f64> = column
            .values
            .iter()
            .copied()
            .filter(|value| !value.is_nan())
            .collect();
        known.len() > 1 && known.windows(2).all(|pair| pair[1] > pair[0])
    };
    let clock = columns.iter().find(|column| column.is_clock);
    let named = columns
        .iter()
        .filter(rises)
        .find(|column| is_time(&column.name));
    let seconds = || {
        columns
            .iter()
            .filter(rises)
            .find(|column| unit_of_time(column).is_some())
    };
    if let Some(column) = named.or_else(seconds) {
        let source = match unit_of_time(column) {
            Some(unit) => format!("{}:{unit}", column.name),
            // Without a unit it is in seconds, or since an epoch that the reader determines by magnitude.
            None => column.name.clone(),
        };
        return Some((column, source, "rises from row to row".to_owned()));
    }
    clock.map(|column| {
        (
            column,
            column.name.clone(),
            "dates or times of day".to_owned(),
        )
    })
}

fn unit_of_time(column: &LogColumn) -> Option<&str> {
    column
        .unit
        .as_deref()
        .filter(|unit| *unit != "V" && fits(unit, TIMES))
}

/// Assignment of a log's column: column, source, reason.
type Proposal<'c> = Option<(&'c LogColumn, String, String)>;

fn proposal<'c>(
    words: &Words,
    columns: impl Iterator<Item = &'c LogColumn>,
) -> Result<Proposal<'c>, Untold> {
    let mut candidates: Vec<Candidate<'c>> = columns
        .filter_map(|column| candidate(words, column))
        .collect();
    candidates.sort_by_key(|candidate| -candidate.score);
    let best = match &candidates[..] {
        [] => return Ok(None),
        [first, second, ..] if first.score == second.score => {
            let is_needed = words.channel.ends_with("current_a");
            return match is_needed {
                true => Err(Untold {
                    what: format!(
                        "{} may be \"{}\" or \"{}\"",
                        words.channel, first.column.name, second.column.name
                    ),
                    mend: format!(
                        "assign it, as in --map {}=\"{}\"",
                        words.channel, first.column.name
                    ),
                }),
                false => Ok(None),
            };
        }
        [first, ..] => first,
    };
    let column = best.column;
    let Some((unit, by_unit)) = unit(words.channel, column) else {
        return Ok(None);
    };
    let reason = format!("{}; {by_unit}", best.by);
    Ok(Some((column, format!("{}:{unit}", column.name), reason)))
}

fn candidate<'c>(words: &Words, column: &'c LogColumn) -> Option<Candidate<'c>> {
    let is_empty = column.values.iter().all(|value| value.is_nan());
    if column.is_clock || (is_empty && !column.values.is_empty()) {
        return None;
    }
    let by_unit = match column.unit.as_deref() {
        Some(unit) if unit == "V" || !fits(unit, words.channel) => return None,
        Some(_) => 2,
        None => 0,
    };
    // For a quantity with a single channel, unit or name suffices; for others the name has to identify the channel.
    let least = if words.is_only_one() { 1 } else { 2 };
    let (by_name, by_comment) = (words.score(&column.name), words.score(&column.comment));
    let (by_words, by) = match by_name {
        name if name >= least => (name, "by its name"),
        0.. if by_comment >= least => (by_comment, "by its comment"),
        0 if words.is_only_one() && by_unit > 0 => (0, "the only one in that unit"),
        _ => return None,
    };
    Some(Candidate {
        column,
        score: by_words * 2 + by_unit,
        by,
    })
}

/// The most likely unit of a column, and the reason; `None` without evidence.
fn unit(channel: &str, column: &LogColumn) -> Option<(String, String)> {
    let known = column.values.iter().filter(|value| value.is_finite());
    let largest = known.fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let said = column.unit.clone();
    let odd = |unit: &str, what: &str| {
        let claimed = said.as_deref().unwrap_or("no unit");
        Some((
            unit.to_owned(),
            format!("values up to {largest:.4} are {what}, although the log states {claimed}"),
        ))
    };
    match (channel, said.as_deref()) {
        ("lift_current_a" | "lower_current_a", Some("A") | None) if largest > MOST_A => {
            odd("mA", "milliampere")
        }
        ("rocker_angle_deg", Some("deg") | None) if largest <= SURELY_RAD && largest > 0.0 => {
            odd("rad", "radians")
        }
        ("rocker_angle_deg", Some("rad")) if largest > 2.0 * MOST_RAD => odd("deg", "degrees"),
        ("lift_current_a" | "lower_current_a", Some("mA")) if largest > 0.0 && largest <= 5.0 => {
            odd("A", "ampere")
        }
        (_, Some(unit)) => Some((unit.to_owned(), format!("in {unit}, as stated in the log"))),
        ("pump_pressure_bar" | "cylinder_pressure_bar", None) if largest > MOST_BAR => None,
        (_, None) => {
            let (_, unit) = run_columns().find(|(name, _)| *name == channel)?;
            Some((
                unit.to_owned(),
                format!("values up to {largest:.4}, assumed {unit}: the log states no unit"),
            ))
        }
    }
}
