//! `[columns]` in `campaign.toml`: mapping of the columns of any log to those of a run.
//!
//! ```toml
//! [columns]
//! time_s = "Zeit:ms"
//! lift_current_a = "Ventil Heben Strom:mA"      # name as in the log, and unit
//! lower_current_a = "Ventil Senken Strom"       # unit as the log says
//! cylinder_pressure_bar = { column = "U_p2", unit = "V", from = [0.5, 4.5], to = [0, 250] }
//! ```

use hitch_input::input_error::quote;
use hitch_input::naming::{nearest, offer_names, unknown_name};
use hitch_input::toml_reader::TomlTable;

use crate::recorded::CampaignError;
use crate::run_columns::{COLUMNS, Column, column};
use crate::scale::{Scale, is_unit_of};

/// Range of raw values.
const ANY: std::ops::RangeInclusive<f64> = -1e12..=1e12;

/// Two raw values, and the corresponding values in the column's unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoPoints {
    /// Raw values.
    pub from: [f64; 2],
    /// Values of the column.
    pub to: [f64; 2],
}

/// The source of a column of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The run's column.
    pub column: &'static Column,
    /// Its name in the log.
    pub name: String,
    /// Its unit in the log; `None` if the log states it.
    pub unit: Option<String>,
    /// Two-point calibration, if any.
    pub points: Option<TwoPoints>,
    /// Whether it is required.
    pub is_required: bool,
}

/// The source of each column of a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ColumnSettings {
    /// One per mapped column.
    pub sources: Vec<Source>,
}

impl Source {
    /// Parses `NAME`, `NAME:UNIT`, or with a two-point calibration `NAME:UNIT 0.5=0 4.5=250`, for the column `key`.
    ///
    /// # Errors
    /// The fault, and a suggested correction.
    pub fn parse(key: &str, text: &str) -> Result<Self, (String, String)> {
        let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
        let Some(column) = column(key) else {
            let what = unknown_name("channel", key, &names);
            return Err((what, offer_names(key, &names)));
        };
        let (text, points) = points(text);
        let (name, unit) = match text.rsplit_once(':') {
            Some((name, unit)) if points.is_some() || is_unit_of(unit, column) => {
                (name, Some(unit.trim().to_owned()))
            }
            _ => (text, None),
        };
        let source = Self {
            column,
            name: name.trim().to_owned(),
            unit,
            points,
            is_required: true,
        };
        source.check()?;
        Ok(source)
    }

    fn check(&self) -> Result<(), (String, String)> {
        let key = self.column.name;
        if self.name.is_empty() {
            let what = format!("{key} has no column name");
            return Err((what, format!("write {key} = \"Name in the log:unit\"")));
        }
        match (&self.unit, self.points) {
            (_, Some(points)) if Scale::through(points.from, points.to).is_none() => Err((
                format!("the two points of {key} do not define a line"),
                "give two different values and their calibrated values".to_owned(),
            )),
            (Some(unit), None) => match Scale::of(unit, self.column) {
                Ok(_) => Ok(()),
                Err(what) => Err((what, how_to_scale(self.column))),
            },
            _ => Ok(()),
        }
    }

    /// The fault of a log that has columns or channels with other names.
    pub fn missing(&self, kind: &str, names: &[&str]) -> (String, String) {
        let what = format!(
            "{kind} {} does not exist; [columns] assigns it to {}",
            quote(&self.name),
            self.column.name
        );
        (what, offer_columns(&self.name, names))
    }

    /// Conversion from a value of the log to one of the run; `logged` is the unit that the log states.
    ///
    /// # Errors
    /// The fault, and a suggested correction.
    pub fn scale(&self, logged: Option<&str>) -> Result<Scale, (String, String)> {
        if let Some(TwoPoints { from, to }) = self.points {
            return Ok(Scale::through(from, to).unwrap_or(Scale::ONE));
        }
        let key = self.column.name;
        let Some(unit) = self.unit.as_deref().or(logged) else {
            let what = format!("{} of {key} has no unit", quote(&self.name));
            let hint = format!(
                "write {key} = \"{}:{}\" under [columns], with its unit",
                self.name, self.column.unit
            );
            return Err((what, hint));
        };
        Scale::of(unit, self.column).map_err(|what| (what, how_to_scale(self.column)))
    }
}

/// The fault of a log of columns or channels, none of which is assigned to a required column.
pub fn unassigned(kind: &str, column: &Column) -> (String, String) {
    let Column { name, unit, .. } = column;
    (
        format!("no {kind} is assigned to {name}"),
        format!("assign it under [columns]: {name} = \"Name:{unit}\""),
    )
}

fn how_to_scale(column: &Column) -> String {
    format!(
        "give a unit like {}, or for a sensor's voltage two points, as in \
         {{ column = \"U1\", unit = \"V\", from = [0.5, 4.5], to = [0, 250] }}",
        column.unit
    )
}

/// Suggestions of column names of the log, for a message.
pub fn offer_columns(given: &str, known: &[&str]) -> String {
    /// Longer lists are not helpful in one line.
    const MOST: usize = 12;
    if let Some(name) = nearest(given, known) {
        return format!("did you mean {name}?");
    }
    let more = if known.len() > MOST { ", ..." } else { "" };
    let named: Vec<&str> = known.iter().take(MOST).copied().collect();
    format!("it has {}{more}", named.join(", "))
}

/// Splits two calibration points off the end of a text.
fn points(text: &str) -> (&str, Option<TwoPoints>) {
    let pair = |word: &str| {
        let (from, to) = word.split_once('=')?;
        Some((number(from)?, number(to)?))
    };
    let split = || {
        let (rest, second) = text.trim_end().rsplit_once(' ')?;
        let (rest, first) = rest.trim_end().rsplit_once(' ')?;
        let (first, second) = (pair(first)?, pair(second)?);
        Some((
            rest.trim_end(),
            TwoPoints {
                from: [first.0, second.0],
                to: [first.1, second.1],
            },
        ))
    };
    match split() {
        Some((rest, points)) => (rest, Some(points)),
        None => (text, None),
    }
}

fn number(text: &str) -> Option<f64> {
    let number: f64 = text.trim().parse().ok()?;
    ANY.contains(&number).then_some(number)
}

impl ColumnSettings {
    /// Every column by its own name; the log states the unit, and may lack optional columns.
    pub fn by_own_names() -> Self {
        let sources = COLUMNS.iter().map(|column| Source {
            column,
            name: column.name.to_owned(),
            unit: Some(column.unit.to_owned()),
            points: None,
            is_required: false,
        });
        Self {
            sources: sources.collect(),
        }
    }

    /// Whether they are those of [`Self::by_own_names`].
    pub fn are_own_names(&self) -> bool {
        self.sources.iter().all(|source| !source.is_required)
    }

    /// Reads the table `[columns]` of a campaign, or of one of its runs.
    ///
    /// # Errors
    /// The first fault, with file, line and column.
    pub fn read(table: &TomlTable<'_>) -> Result<Option<Self>, CampaignError> {
        let Some(columns) = table.table("columns")? else {
            return Ok(None);
        };
        let known: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
        columns.only(&known)?;
        let mut settings = Self::default();
        for column in &COLUMNS {
            let key = column.name;
            if !columns.has(key) {
                continue;
            }
            let source = if columns.is_table(key) {
                source_of_table(&columns, column)?
            } else {
                let text = columns.required_text(key)?;
                Source::parse(key, text)
                    .map_err(|(what, hint)| columns.error_at(key, what, hint))?
            };
            settings.sources.push(source);
        }
        Ok(Some(settings))
    }
}

/// `{ column = "U1", unit = "V", from = [0.5, 4.5], to = [0, 250] }`
fn source_of_table(
    columns: &TomlTable<'_>,
    column: &'static Column,
) -> Result<Source, CampaignError> {
    let key = column.name;
    let Some(table) = columns.table(key)? else {
        return Err(columns.missing(key));
    };
    table.only(&["column", "unit", "from", "to"])?;
    let points = match (two(&table, "from")?, two(&table, "to")?) {
        (Some(from), Some(to)) => Some(TwoPoints { from, to }),
        (None, None) => None,
        (Some(_), None) => return Err(table.missing("to")),
        (None, Some(_)) => return Err(table.missing("from")),
    };
    let source = Source {
        column,
        name: table.required_text("column")?.to_owned(),
        unit: table.text("unit")?.map(str::to_owned),
        points,
        is_required: true,
    };
    source
        .check()
        .map_err(|(what, hint)| columns.error_at(key, what, hint))?;
    Ok(source)
}

fn two(table: &TomlTable<'_>, key: &str) -> Result<Option<[f64; 2]>, CampaignError> {
    let Some(numbers) = table.numbers(key, ANY)? else {
        return Ok(None);
    };
    <[f64; 2]>::try_from(numbers).map(Some).map_err(|numbers| {
        let what = format!("{key} has {} numbers", numbers.len());
        table.error_at(key, what, "a line is defined by two points")
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scale::nominal_linkage;

    #[test]
    fn a_source_is_a_name_with_or_without_a_unit() {
        let source = Source::parse("lift_current_a", "Ventil Heben Strom:mA").unwrap();
        assert_eq!(
            (source.name.as_str(), source.unit.as_deref()),
            ("Ventil Heben Strom", Some("mA"))
        );
        let source = Source::parse("lift_current_a", "Bus: Heben").unwrap();
        assert_eq!((source.name.as_str(), source.unit), ("Bus: Heben", None));
        let source = Source::parse("cylinder_pressure_bar", "U1:V 0.5=0 4.5=250").unwrap();
        assert_eq!(source.name, "U1");
        let scale = source.scale(None).unwrap();
        assert!((scale.apply(2.5, nominal_linkage()) - 125.0).abs() < 1e-9);
    }

    #[test]
    fn what_is_no_source_is_refused() {
        for (key, text, expected) in [
            ("lift_current", "I", "did you mean lift_current_a"),
            ("lift_current_a", ":mA", "has no column name"),
            ("cylinder_pressure_bar", "U1:V", "two points"),
            (
                "cylinder_pressure_bar",
                "U1:V 1=2 1=3",
                "do not define a line",
            ),
        ] {
            let (what, hint) = Source::parse(key, text).unwrap_err();
            assert!(
                format!("{what}; {hint}").contains(expected),
                "{what}; {hint}"
            );
        }
        assert!(
            Source::parse("lift_current_a", "I")
                .unwrap()
                .scale(None)
                .is_err()
        );
    }
}
