//! Units as logs, tools and data sheets write them: other spellings, other languages, multiples, absolute pressures.

use crate::dimension::Dimension;
use crate::unit::Unit;

/// Units with their alternative spellings in lower case: of tools, and in German.
const SPELLINGS: &[(&str, &[&str])] = &[
    ("deg", &["°", "deg", "degree", "degrees", "grad"]),
    ("rad", &["radian", "radians"]),
    ("degC", &["c", "°c", "degc", "deg c", "deg_c", "celsius"]),
    ("degF", &["f", "°f", "degf"]),
    ("l/min", &["lpm", "l/min", "ltr/min", "l min-1"]),
    ("l/s", &["l/s"]),
    ("gpm", &["us gpm", "gal/min"]),
    ("A", &["amp", "amps", "ampere", "a"]),
    ("mA", &["ma"]),
    ("bar", &["bar", "barg", "bar(g)"]),
    ("kPa", &["kpa"]),
    ("Pa", &["pa"]),
    ("psi", &["psig"]),
    ("s", &["sec", "sek", "seconds"]),
    ("V", &["volt"]),
    ("min", &["minute", "minutes", "minuten"]),
    ("h", &["hours", "stunden"]),
    ("ms", &["msec", "millisekunden"]),
    ("us", &["usec"]),
    ("km/h", &["km/h", "kmh", "kph"]),
    ("kN", &["kn"]),
    ("d", &["day", "days", "tage", "datenum"]),
    ("%", &["percent", "prozent"]),
];

/// Units that formulas do not have, each as a multiple of one that they have.
const MULTIPLES: &[(&str, f64, &str)] = &[
    ("psi", 6_894.757_293_168, "Pa"),
    ("hPa", 100.0, "Pa"),
    ("mbar", 1e-3, "bar"),
    // US gallon.
    ("gpm", 3.785_411_784, "l/min"),
    ("ml/min", 1e-3, "l/min"),
    ("uA", 1e-6, "A"),
    ("us", 1e-6, "s"),
    ("µs", 1e-6, "s"),
    ("ns", 1e-9, "s"),
    ("h", 3_600.0, "s"),
    ("km/h", 1.0 / 3.6, "m/s"),
    ("mph", 0.447_04, "m/s"),
    ("d", 86_400.0, "s"),
];

/// Endings of a unit of pressure that make it absolute.
const ABSOLUTE: [&str; 4] = ["(a)", " absolute", " abs", "a"];

/// A unit as formulas write it; a text that is not known as a unit is unchanged.
#[must_use]
pub fn spelling(unit: &str) -> &str {
    let unit = unit.trim();
    let lower = unit.to_lowercase();
    // Capital letters distinguish milli from mega: a known unit is not changed.
    if parsed(unit).is_some() {
        return unit;
    }
    let mut known = SPELLINGS.iter();
    let known = known.find(|(_, others)| others.contains(&lower.as_str()));
    known.map_or(unit, |(usual, _)| usual)
}

/// The unit above air of a unit of absolute pressures, as formulas write it.
#[must_use]
pub fn above_air(unit: &str) -> Option<&str> {
    let is_pressure = |unit: &&str| parsed(unit).is_some_and(|unit| unit.dimension == pressure());
    if is_pressure(&unit) {
        return None;
    }
    let bases = ABSOLUTE
        .iter()
        .filter_map(|ending| unit.strip_suffix(ending));
    bases.map(spelling).find(is_pressure)
}

/// A unit in the spelling of formulas; `None` if the text is none.
#[must_use]
pub fn parsed(unit: &str) -> Option<Unit> {
    let multiple = MULTIPLES.iter().find(|(name, ..)| *name == unit);
    match multiple {
        Some((_, factor, base)) => Unit::parse(base).ok().map(|base| Unit {
            si: base.si * factor,
            dimension: base.dimension,
        }),
        None if unit.is_empty() => None,
        None => Unit::parse(unit).ok(),
    }
}

const fn pressure() -> Dimension {
    Dimension::whole([1, -1, -2, 0, 0])
}

#[cfg(test)]
mod tests {
    use super::{above_air, spelling};

    #[test]
    fn an_absolute_pressure_has_its_unit_above_air() {
        for (unit, above) in [
            ("bara", "bar"),
            ("bar(a)", "bar"),
            ("bar abs", "bar"),
            ("psia", "psi"),
            ("kPaa", "kPa"),
            ("MPa abs", "MPa"),
            ("mbar(a)", "mbar"),
        ] {
            assert_eq!(above_air(unit), Some(above), "{unit}");
        }
        for unit in ["Pa", "bar", "A", "mA", "kPa", "a", ""] {
            assert_eq!(above_air(unit), None, "{unit}");
        }
    }

    #[test]
    fn spellings_of_other_tools_become_those_of_formulas() {
        for (written, usual) in [
            ("L/min", "l/min"),
            ("°", "deg"),
            ("MPa", "MPa"),
            ("Sek", "s"),
            ("Ventil", "Ventil"),
        ] {
            assert_eq!(spelling(written), usual);
        }
    }
}
