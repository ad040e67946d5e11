//! Units of variables, as importers convert them.

use hitch_input::unit::Unit;

/// Base units of an importer, in the order of the exponents of `hitch_input::dimension`.
const BASES: [&str; 5] = ["kg", "m", "s", "A", "K"];
/// Units that are not products of powers, or have no name in this project's files.
const OTHERS: [(&str, &str); 3] = [
    ("degC", r#"K="1" offset="273.15""#),
    ("V", r#"kg="1" m="2" s="-3" A="-1""#),
    ("%", r#"factor="0.01""#),
];

/// The attributes of a unit's `BaseUnit`; `None` for a unit that an importer cannot convert.
pub fn base_attributes(text: &str) -> Option<String> {
    if let Some((_, attributes)) = OTHERS.iter().find(|(name, _)| *name == text) {
        return Some((*attributes).to_owned());
    }
    let unit = Unit::parse(text).ok()?;
    let powers = unit.dimension.whole_powers()?;
    let mut attributes: Vec<String> = BASES
        .iter()
        .zip(powers)
        .filter(|(_, power)| *power != 0)
        .map(|(base, power)| format!(r#"{base}="{power}""#))
        .collect();
    // An angle is a pure number here, and a base unit there.
    if text.starts_with("deg") || text.starts_with("rad") {
        attributes.push(r#"rad="1""#.to_owned());
    }
    if unit.si != 1.0 {
        attributes.push(format!(r#"factor="{}""#, unit.si));
    }
    Some(attributes.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn units_are_given_in_base_units() {
        let shown = |text| base_attributes(text).unwrap();
        assert_eq!(shown("A"), r#"A="1""#);
        assert_eq!(shown("bar"), r#"kg="1" m="-1" s="-2" factor="100000""#);
        assert_eq!(shown("degC"), r#"K="1" offset="273.15""#);
        assert_eq!(
            shown("deg/s"),
            format!(r#"s="-1" rad="1" factor="{}""#, PI / 180.0)
        );
        assert_eq!(base_attributes("m3/s/Pa^0.5"), None);
    }
}
