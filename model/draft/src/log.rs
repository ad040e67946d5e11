//! Logs of a draft campaign: text tables of any dialect, with units in their headers.

use std::path::Path;

use hitch_campaign::survey::{LogColumn, TextTable, text_table};
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
    /// Its unit in the program, then others that may end the name of a column.
    units: &'static [&'static str],
    /// Range of plausible values in the first unit.
    range: [f64; 2],
}

const fn known(name: &'static str, units: &'static [&'static str], range: [f64; 2]) -> Quantity {
    Quantity { name, units, range }
}

/// The quantities that a log has to have.
pub const QUANTITIES: [Quantity; 4] = [
    known("time", &["s", "ms"], [-1e12, 1e12]),
    known("speed", &["m/s", "km/h"], [-10.0, 10.0]),
    known("depth", &["m", "cm", "mm"], [-3.0, 1.5]),
    known("draft", &["N", "kN"], [-1e6, 1e6]),
];

/// The columns that a manifest names for each quantity, in the order of [`QUANTITIES`]; none if the log's own names are used.
/// Several columns of draft are added: the pins of both sides.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mapping {
    /// Names, each with `:unit` behind it if the log states none.
    pub columns: [Vec<String>; 4],
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
    let mut values = vec![[0.0; 4]; table.rows.len()];
    for (of, (quantity, names)) in QUANTITIES.iter().zip(&mapping.columns).enumerate() {
        for (column, factor) in columns(&source, &table, quantity, names)? {
            for (row, logged) in table.numbers(&source, column)?.iter().enumerate() {
                let value = logged * factor;
                check(quantity, column, value)
                    .map_err(|(what, hint)| table.fault(&source, row, column, what, hint))?;
                values[row][of] += value;
            }
        }
    }
    let mut samples: Vec<Sample> = Vec::with_capacity(values.len());
    for (values, byte) in values.into_iter().zip(&table.rows) {
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

fn check(quantity: &Quantity, column: &LogColumn, value: f64) -> Result<(), (String, String)> {
    let ([low, high], unit) = (quantity.range, quantity.units[0]);
    if (low..=high).contains(&value) {
        return Ok(());
    }
    let name = quote(&column.name);
    let what = format!("{name} is {value} {unit}, which is out of range");
    let hint = format!("the range is {low} to {high} {unit}; check the unit in the header");
    Err((what, hint))
}

/// The columns of a quantity, each with the factor to its unit in the program.
fn columns<'t>(
    source: &SourceFile,
    table: &'t TextTable,
    quantity: &Quantity,
    names: &[String],
) -> Result<Vec<(&'t LogColumn, f64)>, InputError> {
    let known: Vec<&str> = table
        .columns
        .iter()
        .map(|column| column.name.as_str())
        .collect();
    let fault = |what: String, hint: String| source.error_at(table.header, what, hint);
    let with_factor = |column: &'t LogColumn, unit: &str| match factor(quantity, column, unit) {
        Ok(factor) => Ok((column, factor)),
        Err((what, hint)) => Err(fault(what, hint)),
    };
    if names.is_empty() {
        let mut own = table.columns.iter();
        let own = own.find_map(|column| Some((column, own_unit(quantity, column)?)));
        let (column, unit) = own.ok_or_else(|| {
            let what = format!("the header has no column of the {}", quantity.name);
            let unit = quantity.units[0];
            let hint = format!(
                "name it {0}_{1}, or {0} with its unit in brackets, or assign one under [columns]: {0} = \"Name:{unit}\"",
                quantity.name, ending(unit)
            );
            fault(what, hint)
        })?;
        return Ok(vec![with_factor(column, unit)?]);
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
        all.push(with_factor(column, unit.unwrap_or_default())?);
    }
    Ok(all)
}

/// The unit of a column that has the quantity's own name; empty if the header does not state it.
fn own_unit<'t>(quantity: &Quantity, column: &'t LogColumn) -> Option<&'t str> {
    let name = column.name.to_lowercase();
    if name == quantity.name {
        return Some(column.unit.as_deref().unwrap_or_default());
    }
    let of_name = name.strip_prefix(quantity.name)?.strip_prefix('_')?;
    let mut units = quantity.units.iter().copied();
    units.find(|unit| ending(unit) == of_name)
}

/// A unit as it ends the project's own names of columns.
fn ending(unit: &str) -> String {
    unit.to_lowercase().replace('/', "_")
}

/// From the unit of a column to that of the program.
fn factor(quantity: &Quantity, column: &LogColumn, unit: &str) -> Result<f64, (String, String)> {
    let usual = quantity.units[0];
    if unit.is_empty() {
        let what = format!("{} has no unit", quote(&column.name));
        let hint = format!("write it in brackets behind the name, for example [{usual}]");
        return Err((what, hint));
    }
    let units = parsed(spelling(unit)).zip(parsed(usual));
    match units.filter(|(own, wanted)| own.dimension == wanted.dimension) {
        Some((own, wanted)) => Ok(own.si / wanted.si),
        None => {
            let what = format!("{} is no unit of the {}", quote(unit), quantity.name);
            Err((what, format!("use for example {usual}")))
        }
    }
}
