//! Assigns a log's columns to a run's columns: by the user's mapping, else by names, units and values.

use hitch_campaign::survey::{LogColumn, TIMES, check_source, fits, is_absolute, run_columns};

use super::doubts::{is_percentage, is_position, not_usable, says_degrees, two_points, why_not};
use super::mapping::{BY_USER, Mapping, Taken, Undetermined};
use super::note::Note;
use super::times::time;
use super::words::{CHANNELS, Words};

/// Largest plausible angle in radians.
const MOST_RAD: f64 = 3.2;
/// Angles within this limit are probably in radians: a working hitch exceeds so many degrees.
const SURELY_RAD: f64 = MOST_RAD;
/// Larger values of a current are in milliampere.
const MOST_A: f64 = 20.0;
/// Largest current of a valve, A, that is taken for ampere although the log states mA.
const MOST_A_IN_MA: f64 = 5.0;
/// The column of the angle.
const ANGLE: &str = "rocker_angle_deg";
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

/// A candidate column with its score.
struct Candidate<'c> {
    column: &'c LogColumn,
    score: i32,
    /// Evidence.
    by: &'static str,
    /// Whether the evidence is weak.
    is_weak: bool,
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
    ) -> Result<Self, Undetermined> {
        match Self::draft(columns, kind, named) {
            (mapping, None) => Ok(mapping),
            (_, Some(undetermined)) => Err(undetermined),
        }
    }

    /// An assignment of the columns that can be determined, and the first one that cannot.
    #[must_use]
    pub fn draft(
        columns: &[LogColumn],
        kind: Kind,
        named: &[(String, String)],
    ) -> (Self, Option<Undetermined>) {
        let mut mapping = Self::default();
        let mut undetermined: Option<Undetermined> = None;
        let mut used: Vec<String> = Vec::new();
        let mut left_out: Vec<&str> = Vec::new();
        for (channel, source) in named {
            if source.is_empty() {
                left_out.push(channel);
                continue;
            }
            let named = mapping.name(channel, source, BY_USER);
            let named = named.and_then(|name| {
                let fault = (kind != Kind::Signals)
                    .then(|| not_usable(columns, &name))
                    .flatten();
                fault.map_or(Ok(name), Err)
            });
            match named {
                Ok(name) => used.push(name),
                Err(what) => {
                    undetermined.get_or_insert(Undetermined {
                        what: format!("--map {channel}={source}: {what}"),
                        hint: "write it as --map CHANNEL=\"NAME:UNIT\"".to_owned(),
                    });
                }
            }
        }
        let in_ma = columns
            .iter()
            .filter(|column| column.unit.as_deref() == Some("mA"));
        let largest_ma = in_ma.map(largest).fold(0.0, f64::max);
        for words in &CHANNELS {
            if mapping.has(words.channel) || left_out.contains(&words.channel) {
                continue;
            }
            let free = columns.iter().filter(|column| !used.contains(&column.name));
            match proposal(words, kind, free, largest_ma) {
                Ok(Some((column, taken))) => {
                    used.push(column.name.clone());
                    mapping.taken.push(taken);
                }
                Ok(None) => {}
                Err(unclear) => {
                    undetermined.get_or_insert(unclear);
                }
            }
        }
        if kind == Kind::Table && !mapping.has(TIMES) {
            match time(columns, mapping.source_of(columns, "lift_current_a")) {
                Ok(Some(taken)) => mapping.taken.push(taken),
                Err(implausible) => {
                    undetermined.get_or_insert(implausible);
                }
                Ok(None) => {
                    undetermined.get_or_insert_with(|| no_times(columns));
                }
            }
        }
        mapping.note(columns, &left_out);
        let times = match kind {
            Kind::Table => mapping.note_other_times(columns),
            Kind::Channels => mapping.check_own_times(columns, named),
            Kind::Signals => Ok(()),
        };
        if let Err(implausible) = times {
            undetermined.get_or_insert(implausible);
        }
        let complete = mapping.check(columns);
        mapping.order();
        (mapping, undetermined.or(complete.err()))
    }

    /// The assignment that the user gives, and nothing else.
    ///
    /// # Errors
    /// If a column is not in the log, its unit is not one of the quantity, or a required column is missing.
    pub fn given(
        columns: &[LogColumn],
        kind: Kind,
        named: &[(String, String)],
    ) -> Result<Self, Undetermined> {
        let mut mapping = Self::default();
        let wrong = |what: String| Undetermined {
            what,
            hint: "choose another column or unit, or enter two known points of the sensor"
                .to_owned(),
        };
        for (channel, source) in named {
            if mapping.has(channel) {
                return Err(wrong(format!("{channel} is assigned twice")));
            }
            let name = mapping
                .name(channel, source, "given by the user")
                .map_err(wrong)?;
            if columns.iter().all(|column| column.name != name) {
                return Err(wrong(format!("there is no column \"{name}\"")));
            }
        }
        if kind == Kind::Table && !mapping.has(TIMES) {
            return Err(no_times(columns));
        }
        mapping.check(columns)?;
        mapping.order();
        Ok(mapping)
    }

    /// Assigns a column as named by the user; returns its name in the log.
    fn name(&mut self, channel: &str, source: &str, reason: &str) -> Result<String, String> {
        let (name, _) = check_source(channel, source)?;
        if let Some((channel, _)) = run_columns().find(|(known, _)| *known == channel) {
            self.taken.push(Taken {
                channel,
                source: source.to_owned(),
                reason: reason.to_owned(),
                is_assumed: false,
            });
        }
        Ok(name)
    }

    /// Sorts the columns as those of a run.
    fn order(&mut self) {
        self.taken
            .sort_by_key(|taken| run_columns().position(|(name, _)| name == taken.channel));
    }

    /// Notes the columns of a known quantity that are not used, and pressures above vacuum.
    fn note(&mut self, columns: &[LogColumn], left_out: &[&str]) {
        let used: Vec<&str> = self
            .taken
            .iter()
            .filter_map(|taken| self.source_of(columns, taken.channel))
            .map(|column| column.name.as_str())
            .collect();
        let mut notes = Vec::new();
        for column in columns
            .iter()
            .filter(|column| !used.contains(&&*column.name))
        {
            let known = CHANNELS.iter().find(|words| {
                let is_missing = !self.has(words.channel) && !left_out.contains(&words.channel);
                (is_missing || column.fault.is_some()) && words.names(column)
            });
            let reason = known.and_then(|words| why_not(words.channel, column));
            notes.extend(reason.map(|reason| Note {
                what: format!("left out: \"{}\": {}", column.name, reason.what),
                ..reason
            }));
        }
        for taken in &self.taken {
            let column = self.source_of(columns, taken.channel);
            let unit = column.and_then(|column| column.unit.as_deref());
            if unit.is_some_and(is_absolute) {
                notes.push(Note::plain(format!(
                    "assumed: {} is above vacuum; 1.013 bar of air are subtracted",
                    taken.channel
                )));
            }
            if let Some(column) = column.filter(|column| {
                let is_proposed = taken.is_proposed();
                is_proposed && taken.channel == ANGLE && is_percentage(&column.values)
            }) {
                notes.push(Note {
                    what: format!(
                        "assumed: \"{}\" is in {} as the log states, though its values from 0 to 100 rest on an end as \
                         percentages do",
                        column.name,
                        unit.unwrap_or("deg")
                    ),
                    hint: Some(format!(
                        "for percentages give {}",
                        two_points(ANGLE, &column.name, "%")
                    )),
                });
            }
        }
        self.notes = notes;
    }

    /// The column of the log that is assigned to a column of the run.
    pub(super) fn source_of<'c>(
        &self,
        columns: &'c [LogColumn],
        channel: &str,
    ) -> Option<&'c LogColumn> {
        let taken = self.taken.iter().find(|taken| taken.channel == channel)?;
        let (name, _) = check_source(channel, &taken.source).ok()?;
        columns.iter().find(|column| column.name == name)
    }

    fn has(&self, channel: &str) -> bool {
        self.taken.iter().any(|taken| taken.channel == channel)
    }

    fn check(&self, columns: &[LogColumn]) -> Result<(), Undetermined> {
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
        if measured.iter().any(|channel| self.has(channel)) {
            Ok(())
        } else {
            Err(missing(measured[0], "a run needs a measurement", columns))
        }
    }
}

fn no_times(columns: &[LogColumn]) -> Undetermined {
    missing(TIMES, "times have to rise from row to row", columns)
}

fn missing(channel: &str, why: &str, columns: &[LogColumn]) -> Undetermined {
    const MOST: usize = 16;
    let words = CHANNELS.iter().find(|words| words.channel == channel);
    let unusable = columns.iter().find_map(|column| {
        let fault = column.fault.as_ref()?;
        let is_it = words.is_some_and(|words| words.names(column));
        is_it.then(|| format!("\"{}\" cannot be used: {fault}", column.name))
    });
    let names: Vec<&str> = columns
        .iter()
        .take(MOST)
        .map(|column| column.name.as_str())
        .collect();
    let more = if columns.len() > MOST { ", ..." } else { "" };
    Undetermined {
        what: match unusable {
            Some(unusable) => format!("{channel} is missing: {unusable}"),
            None => format!("no column was recognised as {channel}; {why}"),
        },
        hint: format!(
            "assign it with --map {channel}=\"NAME:UNIT\"; columns: {}{more}",
            names.join(", ")
        ),
    }
}

/// A column that is one of several: its name, unit and number of samples.
fn described(column: &LogColumn) -> String {
    let unit = column.unit.as_deref().unwrap_or("no unit");
    match column.values.iter().filter(|value| !value.is_nan()).count() {
        0 => format!("\"{}\" ({unit})", column.name),
        samples => format!("\"{}\" ({unit}, {samples} samples)", column.name),
    }
}

/// Assignment of a log's column.
type Proposal<'c> = Option<(&'c LogColumn, Taken)>;

fn proposal<'c>(
    words: &Words,
    kind: Kind,
    columns: impl Iterator<Item = &'c LogColumn>,
    largest_ma: f64,
) -> Result<Proposal<'c>, Undetermined> {
    let mut candidates: Vec<Candidate<'c>> = columns
        .filter_map(|column| candidate(words, column))
        .collect();
    candidates.sort_by_key(|candidate| -candidate.score);
    let best = match &candidates[..] {
        [] => return Ok(None),
        [first, second, ..] if first.score == second.score => {
            let is_needed = words.channel.ends_with("current_a");
            return if is_needed {
                Err(Undetermined {
                    what: format!(
                        "{} may be {} or {}",
                        words.channel,
                        described(first.column),
                        described(second.column)
                    ),
                    hint: format!(
                        "assign it, as in --map {0}=\"{1}\" or --map {0}=\"{2}\"",
                        words.channel, first.column.name, second.column.name
                    ),
                })
            } else {
                Ok(None)
            };
        }
        [first, ..] => first,
    };
    let column = best.column;
    let is_implausible = column.unit.is_none()
        && words.channel == ANGLE
        && !says_degrees(&column.name)
        && (is_position(&column.name) || is_percentage(&column.values));
    if is_implausible && kind != Kind::Signals {
        return Err(Undetermined {
            what: format!(
                "\"{}\" has no unit: it may be an angle, a percentage or a travel",
                column.name
            ),
            hint: format!(
                "give it, as in --map {0}=\"{1}:deg\", in percent with two points {2}, or leave it out with --map {0}=",
                words.channel,
                column.name,
                two_points(words.channel, &column.name, "%")
            ),
        });
    }
    let Some((unit, by_unit)) = unit(words.channel, column, largest_ma) else {
        return Ok(None);
    };
    let is_stated = column.unit.as_ref() == Some(&unit);
    let source = match kind {
        Kind::Signals => column.name.clone(),
        Kind::Table | Kind::Channels => format!("{}:{unit}", column.name),
    };
    let taken = Taken {
        channel: words.channel,
        source,
        reason: format!("{}; {by_unit}", best.by),
        is_assumed: best.is_weak || !is_stated,
    };
    Ok(Some((column, taken)))
}

fn candidate<'c>(words: &Words, column: &'c LogColumn) -> Option<Candidate<'c>> {
    let is_empty = column.values.iter().all(|value| value.is_nan());
    let is_time = column.times.as_ref() == Some(&column.name);
    if column.is_clock
        || is_time
        || column.fault.is_some()
        || (is_empty && !column.values.is_empty())
    {
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
    let (by_words, by, is_weak) = match by_name {
        name if name >= least => (name, "by its name", false),
        0.. if by_comment >= least => (by_comment, "by its comment", false),
        0 if words.is_only_one() && by_unit > 0 => (0, "the only one in that unit", true),
        _ => return None,
    };
    Some(Candidate {
        column,
        score: by_words * 2 + by_unit,
        by,
        is_weak,
    })
}

/// The largest magnitude in a column.
fn largest(column: &LogColumn) -> f64 {
    let known = column.values.iter().filter(|value| value.is_finite());
    known.fold(0.0_f64, |largest, value| largest.max(value.abs()))
}

/// The most likely unit of a column, and the reason; `None` without evidence. `largest_ma`: of all columns stated in mA. A valve that is
/// off shows some milliampere; where no current is larger they are ampere.
fn unit(channel: &str, column: &LogColumn, largest_ma: f64) -> Option<(String, String)> {
    let largest = largest(column);
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
        ("lift_current_a" | "lower_current_a", Some("mA"))
            if largest > 0.0 && largest_ma <= MOST_A_IN_MA =>
        {
            odd("A", "ampere")
        }
        (_, Some(unit)) => Some((unit.to_owned(), format!("{unit} in the log"))),
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
