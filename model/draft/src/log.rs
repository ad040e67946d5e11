//! Logs of a draft campaign: text tables of any dialect, with units in their headers.

use std::path::Path;

use hitch_campaign::survey::{LogColumn, TextTable, text_table};
use hitch_input::Unit;
use hitch_input::input_error::{InputError, quote};
use hitch_input::naming::offer_names;
use hitch_input::source_file::SourceFile;
use hitch_input::written_unit::{parsed, spelling};

use crate::block::Sample;

/// A quantity of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// Its name, which a column may have.
    pub name: &'static str,
    /// Its unit in the program, of which other units are converted.
    unit: &'static str,
    /// Endings of the project's own column names, each with its unit.
    own: &'static [(&'static str, &'static str)],
    /// Range of plausible values in that unit.
    range: [f64; 2],
}

/// The quantities that a log has to have.
pub const QUANTITIES: [Quantity; 4] = [
    Quantity {
        name: "time",
        unit: "s",
        own: &[("s", "s"), ("ms", "ms")],
        range: [-1e12, 1e12],
    },
    Quantity {
        name: "speed",
        unit: "m/s",
        own: &[("m_s", "m/s"), ("km_h", "km/h")],
        range: [-10.0, 10.0],
    },
    Quantity {
        name: "depth",
        unit: "m",
        own: &[("m", "m"), ("cm", "cm"), ("mm", "mm")],
        range: [-3.0, 1.5],
    },
    Quantity {
        name: "draft",
        unit: "N",
        own: &[("n", "N"), ("kn", "kN")],
        range: [-1e6, 1e6],
    },
];

/// The columns that a manifest names for each quantity, in the order of [`QUANTITIES`]; none if the log's own names are used.
/// Several columns of draft are added: the pins of both sides.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mapping {
    /// Names, each with `:unit` behind it if the log states none.
    pub columns: [Vec<String>; 4],
}

/// A column of a quantity with the size of its unit.
struct Found<'t> {
    column: &'t LogColumn,
    factor: f64,
}

/// Reads the samples of a log.
///
/// # Errors
/// The first fault, with line and column.
pub fn read(path: &Path, mapping: &Mapping) -> Result<Vec<Sample>, InputError> {
    let source = SourceFile::read_any(path)?;
    let table = text_table(&source)?.ok_or_else(|| {
        let hint = "export it with a header such as time_s,speed_m_s,depth_m,draft_n";
        source.error(
            "is not a table: there is no header above rows of numbers",
            hint,
        )
    })?;
    let mut found = Vec::new();
    for (quantity, names) in QUANTITIES.iter().zip(&mapping.columns) {
        found.push(columns(&source, &table, quantity, names)?);
    }
    let mut samples: Vec<Sample> = Vec::with_capacity(table.rows.len());
    for (row, byte) in table.rows.iter().enumerate() {
        let mut values = [0.0; 4];
        for ((value, quantity), columns) in values.iter_mut().zip(&QUANTITIES).zip(&found) {
            for Found { column, factor } in columns {
                let read = column.values.get(row).copied().unwrap_or(f64::NAN) * factor;
                check(&source, *byte, quantity, column, read)?;
                *value += read;
            }
        }
        let [time_s, speed_m_s, depth_m, draft_n] = values;
        if samples.last().is_some_and(|last| last.time_s >= time_s) {
            let what = format!("time {time_s} s is not later than that of the row before");
            return Err(source.error_at(
                *byte,
                what,
                "sort the rows by time, and delete repeated ones",
            ));
        }
        samples.push(Sample {
            time_s,
            speed_m_s,
            depth_m,
            draft_n,
        });
    }
    Ok(samples)
}

fn check(
    source: &SourceFile,
    byte: usize,
    quantity: &Quantity,
    column: &LogColumn,
    value: f64,
) -> Result<(), InputError> {
    let name = quote(&column.name);
    if !value.is_finite() {
        let what = format!("{name} has no number in this row");
        let hint = "delete the row, or give it a number";
        return Err(source.error_at(byte, what, hint));
    }
    let [low, high] = quantity.range;
    if (low..=high).contains(&value) {
        return Ok(());
    }
    let unit = quantity.unit;
    let what = format!("{name} is {value} {unit}, which is out of range");
    let hint = format!("the range is {low} to {high} {unit}; check the unit in the header");
    Err(source.error_at(byte, what, hint))
}

/// The columns of a quantity.
fn columns<'t>(
    source: &SourceFile,
    table: &'t TextTable,
    quantity: &Quantity,
    names: &[String],
) -> Result<Vec<Found<'t>>, InputError> {
    let known: Vec<&str> = table
        .columns
        .iter()
        .map(|column| column.name.as_str())
        .collect();
    let fault = |what: String, hint: String| source.error_at(table.header, what, hint);
    if names.is_empty() {
        let mut own = table.columns.iter().filter_map(|column| {
            let unit = own_unit(quantity, column)?;
            Some((column, unit))
        });
        let (column, unit) = own.next().ok_or_else(|| {
            let (ending, _) = quantity.own[0];
            let what = format!("the header has no column of the {}", quantity.name);
            let hint = format!(
                "name it {0}_{ending}, or {0} with its unit in brackets, or assign one under [columns]: {0} = \"Name:{1}\"",
                quantity.name, quantity.unit
            );
            fault(what, hint)
        })?;
        return Ok(vec![
            found(quantity, column, unit).map_err(|(what, hint)| fault(what, hint))?,
        ]);
    }
    let mut all = Vec::new();
    for written in names {
        let with_name = |name: &str| table.columns.iter().find(|column| column.name == name);
        let (column, unit) = match (with_name(written), written.rsplit_once(':')) {
            (Some(column), _) => (Some(column), column.unit.as_deref()),
            (None, Some((name, unit))) => (with_name(name.trim()), Some(unit.trim())),
            (None, None) => (None, None),
        };
        let Some(column) = column else {
            let what = format!(
                "column {} does not exist; [columns] assigns it to {}",
                quote(written),
                quantity.name
            );
            return Err(fault(what, offer_names(written, &known)));
        };
        let unit = unit.unwrap_or_default();
        all.push(found(quantity, column, unit).map_err(|(what, hint)| fault(what, hint))?);
    }
    Ok(all)
}

/// The unit of a column that has the quantity's own name; empty if the header does not state it.
fn own_unit<'t>(quantity: &Quantity, column: &'t LogColumn) -> Option<&'t str> {
    let name = column.name.to_lowercase();
    if name == quantity.name {
        return Some(column.unit.as_deref().unwrap_or_default());
    }
    let ending = name.strip_prefix(quantity.name)?.strip_prefix('_')?;
    let mut own = quantity.own.iter();
    own.find(|(known, _)| *known == ending)
        .map(|(_, unit)| *unit)
}

fn found<'t>(
    quantity: &Quantity,
    column: &'t LogColumn,
    unit: &str,
) -> Result<Found<'t>, (String, String)> {
    let name = quote(&column.name);
    if unit.is_empty() {
        let what = format!("{name} has no unit");
        let hint = format!(
            "write it in brackets behind the name, for example [{}]",
            quantity.unit
        );
        return Err((what, hint));
    }
    let wanted = Unit::parse(quantity.unit).map_err(|fault| (fault.to_string(), String::new()))?;
    match parsed(spelling(unit)).filter(|unit| unit.dimension == wanted.dimension) {
        Some(unit) => Ok(Found {
            column,
            factor: unit.si / wanted.si,
        }),
        None => {
            let what = format!("{} is no unit of the {}", quote(unit), quantity.name);
            Err((what, format!("use for example {}", quantity.unit)))
        }
    }
}
