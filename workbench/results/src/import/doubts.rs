//! Columns that are not used, or only with a doubt: the reason, in a line.

use hitch_campaign::survey::{LogColumn, fits, is_in, without_group, words};

use super::note::Note;

/// Why a column that the user names cannot be used.
pub fn not_usable(columns: &[LogColumn], name: &str) -> Option<String> {
    if let Some(column) = columns.iter().find(|column| column.name == name) {
        return column.fault.clone();
    }
    let plain = |column: &&LogColumn| {
        let number = column.name.rsplit_once(" #").map(|(plain, _)| plain);
        number.or(without_group(&column.name)) == Some(name)
    };
    let equal: Vec<String> = columns
        .iter()
        .filter(plain)
        .map(|column| format!("\"{}\"", column.name))
        .collect();
    if !equal.is_empty() {
        let names = equal.join(" or ");
        return Some(format!("several columns have this name; write {names}"));
    }
    let (known, unit) = name.rsplit_once(':')?;
    let is_known = columns.iter().any(|column| column.name == known.trim());
    is_known.then(|| format!("\"{unit}\" is not a unit of it"))
}

/// Why a column of a quantity was not proposed; `None` for an unknown reason.
pub fn why_not(channel: &str, column: &LogColumn) -> Option<Note> {
    if let Some(fault) = &column.fault {
        return Some(Note::plain(fault.clone()));
    }
    let has_numbers = column.values.iter().any(|value| value.is_finite());
    match column.unit.as_deref() {
        _ if !has_numbers && !column.values.is_empty() => {
            Some(Note::plain("it contains no numbers".to_owned()))
        }
        Some(unit @ ("%" | "V")) => Some(Note {
            what: format!("it is in {unit}"),
            hint: Some(format!(
                "give two points, as in {}",
                two_points(channel, &column.name, unit)
            )),
        }),
        Some(unit) if !fits(unit, channel) => {
            Some(Note::plain(format!("{unit} is not a unit of {channel}")))
        }
        _ => Some(Note {
            what: format!("several columns may be {channel}"),
            hint: Some(format!(
                "assign one with --map {channel}=\"{}\"",
                column.name
            )),
        }),
    }
}

/// The argument that assigns a column by two points.
pub fn two_points(channel: &str, name: &str, unit: &str) -> String {
    format!("--map {channel}=\"{name}:{unit} 0=50 100=120\"")
}

/// Whether a column is one of a cylinder's or hitch's position, whose unit cannot be assumed.
pub fn is_position(name: &str) -> bool {
    const ANGLES: [&str; 4] = ["winkel", "angle", "phi", "rocker"];
    let words = words(name);
    !ANGLES.iter().any(|known| is_in(known, &words))
}

/// Whether a name ends in the unit, as in `angle_deg`.
pub fn says_degrees(name: &str) -> bool {
    const DEGREES: [&str; 4] = ["deg", "degree", "degrees", "grad"];
    let words = words(name);
    words
        .last()
        .is_some_and(|last| DEGREES.contains(&last.as_str()))
}

/// Whether values run within 0 to 100 and rest on an end: a percentage.
pub fn is_percentage(values: &[f64]) -> bool {
    const REST: usize = 5;
    let known: Vec<f64> = values
        .iter()
        .copied()
        .filter(|value| value.is_finite())
        .collect();
    let at = |end: f64| known.iter().filter(|value| **value == end).count();
    known.iter().all(|value| (0.0..=100.0).contains(value)) && at(100.0).max(at(0.0)) >= REST
}
