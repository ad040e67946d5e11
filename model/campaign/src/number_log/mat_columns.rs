//! The columns of a MAT file: vectors, columns of matrices, fields of structs, and time series.
//!
//! ```text
//! t, heben, ...                          vectors
//! log.t, log.heben, ...                  a struct of vectors
//! log(:,1), log(:,2), ...                a matrix, along its longer dimension
//! heben.Time, heben.Data                 a time series: the channel `heben` with its own times
//! out.time, out.signals(k).values        "structure with time" of Simulink, by the labels of its signals
//! exp.X(i).Data, exp.Y(k).Data           a recording of dSPACE, by the names inside `Y(k)`; `Y(k).XIndex` is i
//! ```

use hitch_mat_file::{Value, variables};

use super::number_column::{Fault, NumberColumn};
use crate::time_base::unit_size_s;

/// Most columns of a matrix: larger ones are no logs.
const MOST_COLUMNS: usize = 64;
const HINT: &str = "save it again: save('log.mat', 't', 'heben', ..., '-v7')";

/// The fields of a struct.
type Fields = [(String, Value)];

/// Reads the columns of a file.
///
/// # Errors
/// The file is broken, or contains no vectors.
pub fn read(bytes: &[u8]) -> Result<Vec<NumberColumn>, Fault> {
    let variables = variables(bytes).map_err(|what| (what, HINT))?;
    let mut columns = Vec::new();
    for (name, value) in &variables {
        add(name, value, &mut columns);
    }
    let has_objects = variables
        .iter()
        .any(|(_, value)| matches!(value, Value::Object));
    match columns.is_empty() {
        true if has_objects => Err((
            "contains timeseries, tables or other objects, which only MATLAB can read".to_owned(),
            "save structs: heben = struct('Time', ts.Time, 'Data', ts.Data), or table2struct(t, 'ToScalar', true)",
        )),
        true => Err(("contains no vectors of numbers".to_owned(), HINT)),
        false => Ok(columns),
    }
}

/// Adds the columns of a value.
fn add(name: &str, value: &Value, columns: &mut Vec<NumberColumn>) {
    match value {
        Value::Numbers { size, values } => columns.extend(of_matrix(name, *size, values)),
        Value::Structs(structs) => {
            for (index, fields) in structs.iter().enumerate() {
                match structs.len() {
                    1 => add_struct(name, fields, columns),
                    _ => add_struct(&format!("{name}({})", index + 1), fields, columns),
                }
            }
        }
        Value::Text(_) | Value::Object | Value::Other => {}
    }
}

fn add_struct(name: &str, fields: &Fields, columns: &mut Vec<NumberColumn>) {
    if let Some(timed) = of_dspace(fields).or_else(|| time_series(name, fields)) {
        columns.extend(timed);
        return;
    }
    for (field, value) in fields {
        add(&format!("{name}.{field}"), value, columns);
    }
}

/// The columns of a struct with times and data; `None` for other structs.
fn time_series(name: &str, fields: &Fields) -> Option<Vec<NumberColumn>> {
    let times = vector(field(fields, &["time", "t"])?)?;
    let mut columns = match field(fields, &["signals"]) {
        Some(Value::Structs(signals)) => of_signals(name, signals),
        _ => {
            let mut columns = of_data(name, fields, &["data", "values", "value"])?;
            for column in &mut columns {
                column.unit = unit(fields);
            }
            columns
        }
    };
    columns.retain(|column| column.values.len() == times.len());
    for column in &mut columns {
        column.times = Some(times.to_vec());
    }
    (!columns.is_empty()).then_some(columns)
}

/// The columns of a recording of dSPACE; `None` for other structs.
fn of_dspace(fields: &Fields) -> Option<Vec<NumberColumn>> {
    let (Value::Structs(axes), Value::Structs(signals)) =
        (field(fields, &["x"])?, field(fields, &["y"])?)
    else {
        return None;
    };
    let data = |fields: &Fields| vector(field(fields, &["data"])?).map(<[f64]>::to_vec);
    let signal = |fields: &Vec<(String, Value)>| {
        let values = data(fields)?;
        let index = match field(fields, &["xindex"]) {
            Some(Value::Numbers { values, .. }) => *values.first()? as usize,
            _ => 1,
        };
        let axis = axes.get(index.checked_sub(1)?)?;
        let unit_of_time = unit(axis);
        let size_s = unit_of_time.as_deref().map_or(1.0, unit_size_s);
        let times_s = data(axis)?.into_iter().map(|time| time * size_s);
        let times_s = times_s.collect::<Vec<f64>>();
        (times_s.len() == values.len()).then_some(NumberColumn {
            name: text(fields, &["name"])?,
            unit: unit(fields),
            values,
            times: Some(times_s),
            states_times: unit_of_time.is_some(),
        })
    };
    let columns: Vec<NumberColumn> = signals.iter().filter_map(signal).collect();
    (!columns.is_empty()).then_some(columns)
}

fn of_signals(name: &str, signals: &[Vec<(String, Value)>]) -> Vec<NumberColumn> {
    let signal = |(index, fields): (usize, &Vec<(String, Value)>)| {
        let label = text(fields, &["label"]);
        let label = label.unwrap_or_else(|| format!("{name}.signals({})", index + 1));
        of_data(&label, fields, &["values"]).unwrap_or_default()
    };
    signals.iter().enumerate().flat_map(signal).collect()
}

fn of_data(name: &str, fields: &Fields, known: &[&str]) -> Option<Vec<NumberColumn>> {
    match field(fields, known)? {
        Value::Numbers { size, values } => Some(of_matrix(name, *size, values)),
        _ => None,
    }
}

/// The unit of a time series.
fn unit(fields: &Fields) -> Option<String> {
    if let Some(Value::Structs(about)) = field(fields, &["datainfo"]) {
        return about.first().and_then(|fields| unit(fields));
    }
    text(fields, &["units", "unit"])
}

/// A text that is not blank.
fn text(fields: &Fields, known: &[&str]) -> Option<String> {
    match field(fields, known)? {
        Value::Text(text) if !text.trim().is_empty() => Some(text.trim().to_owned()),
        _ => None,
    }
}

/// A field by its name in lower case.
fn field<'f>(fields: &'f Fields, known: &[&str]) -> Option<&'f Value> {
    let is_it = |name: &str| known.contains(&&*name.to_ascii_lowercase());
    let found = fields.iter().find(|(name, _)| is_it(name));
    found.map(|(_, value)| value)
}

fn vector(value: &Value) -> Option<&[f64]> {
    match value {
        Value::Numbers { size, values } if size.contains(&1) && values.len() > 1 => Some(values),
        _ => None,
    }
}

/// The vectors of a matrix along its longer dimension; none of a single number, which is a parameter.
fn of_matrix(name: &str, [rows, columns]: [usize; 2], values: &[f64]) -> Vec<NumberColumn> {
    let column = |name: String, values: Vec<f64>| NumberColumn {
        name,
        values,
        ..NumberColumn::default()
    };
    let (length, count) = (rows.max(columns), rows.min(columns));
    if length < 2 || count == 0 || count > MOST_COLUMNS {
        return Vec::new();
    }
    if count == 1 {
        return vec![column(name.to_owned(), values.to_vec())];
    }
    let part = |index: usize| {
        if rows == length {
            column(
                format!("{name}(:,{})", index + 1),
                values[index * rows..(index + 1) * rows].to_vec(),
            )
        } else {
            column(
                format!("{name}({},:)", index + 1),
                values.iter().skip(index).step_by(rows).copied().collect(),
            )
        }
    };
    (0..count).map(part).collect()
}
