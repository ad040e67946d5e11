//! Messages about unknown names.
//!
//! Names of quantities end in their unit (`flow_lpm`). A name that differs from a known one only after the last
//! underscore is therefore that quantity in an unknown unit.

use crate::input_error::quote;

/// Smallest similarity (Jaro-Winkler, 0 to 1) of a known name to be suggested.
const SMALLEST_SIMILARITY: f64 = 0.84;

/// Fault of the name `given` of a `kind` ("column", "key", "effect") that is not in `known`.
pub fn unknown_name(kind: &str, given: &str, known: &[&str]) -> String {
    if let Some((unit, right)) = wrong_unit(given, known) {
        return format!(
            "unit {} is not known, this {kind} has to be {right}",
            plain(unit)
        );
    }
    format!("{kind} {} is not known", quote(given))
}

/// Suggests the most similar known name, or lists all if none is similar.
pub fn offer_names(given: &str, known: &[&str]) -> String {
    if let Some((_, right)) = wrong_unit(given, known) {
        return format!("convert the values and rename it to {right}");
    }
    match nearest(given, known) {
        Some(name) => format!("did you mean {name}?"),
        None => format!("known: {}", known.join(", ")),
    }
}

/// The known name that is most similar to `given`, if any is similar.
pub fn nearest<'a>(given: &str, known: &[&'a str]) -> Option<&'a str> {
    let given = given.to_lowercase();
    known
        .iter()
        .map(|name| (strsim::jaro_winkler(&given, &name.to_lowercase()), *name))
        .filter(|(similarity, _)| *similarity >= SMALLEST_SIMILARITY)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, name)| name)
}

/// Splits `given` into its unit and the known name of the same quantity.
fn wrong_unit<'a, 'k>(given: &'a str, known: &[&'k str]) -> Option<(&'a str, &'k str)> {
    let (quantity, unit) = given.rsplit_once('_')?;
    let right = known.iter().find(|name| {
        name.rsplit_once('_')
            .is_some_and(|(known, _)| known == quantity)
    })?;
    (*right != given && !unit.is_empty()).then_some((unit, *right))
}

/// A unit, quoted unless it is a plain word.
fn plain(unit: &str) -> String {
    let is_word = unit.len() <= 20 && unit.chars().all(char::is_alphanumeric);
    if is_word {
        unit.to_owned()
    } else {
        quote(unit)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [&str; 3] = ["time_s", "flow_lpm", "rocker_angle_deg"];

    #[test]
    fn tells_a_unit_from_a_name() {
        let what = unknown_name("column", "rocker_angle_rad", &KNOWN);
        assert_eq!(
            what,
            "unit rad is not known, this column has to be rocker_angle_deg"
        );
        assert_eq!(
            unknown_name("column", "speed", &KNOWN),
            "column \"speed\" is not known"
        );
    }

    #[test]
    fn offers_the_nearest_or_all() {
        assert_eq!(
            offer_names("roker_angle", &KNOWN),
            "did you mean rocker_angle_deg?"
        );
        assert_eq!(
            offer_names("zzz", &KNOWN),
            "known: time_s, flow_lpm, rocker_angle_deg"
        );
    }
}
