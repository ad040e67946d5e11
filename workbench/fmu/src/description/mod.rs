//! `modelDescription.xml`: what an importer has to know of a unit.

mod fmi2;
mod fmi3;

use std::collections::BTreeSet;
use std::fmt::Write as _;

use crate::content::Kind;
use crate::controller;
use crate::units;
use crate::variable::{Causality, Variable};
use crate::version::Version;

/// Categories of messages.
pub const LOG_CATEGORIES: [&str; 2] = ["logStatusDiscard", "logStatusError"];

/// What a unit is.
#[derive(Debug, Clone, Copy)]
pub struct About<'a> {
    /// What is simulated.
    pub kind: Kind,
    /// Name of the model.
    pub name: &'a str,
    /// Checksum of the unit.
    pub guid: &'a str,
}

impl About<'_> {
    /// What is simulated, in words.
    const fn text(&self) -> &'static str {
        match self.kind {
            Kind::Plant => "electro-hydraulic three-point hitch: valves, cylinder, linkage, load",
            Kind::Controller => "the firmware's controller of a three-point hitch",
        }
    }
}

/// The text of the file. (Writing to a string cannot fail.)
#[must_use]
pub fn write(version: Version, about: About<'_>, variables: &[Variable]) -> String {
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    match version {
        Version::Two => fmi2::write_head(&mut xml, about),
        Version::Three => fmi3::write_head(&mut xml, about),
    }
    let of_time = (version == Version::Three).then_some(fmi3::TIME_UNIT);
    write_units(&mut xml, variables, of_time);
    xml.push_str("  <LogCategories>\n");
    for category in LOG_CATEGORIES {
        let _ = writeln!(xml, "    <Category name=\"{category}\"/>");
    }
    let _ = write!(
        xml,
        "  </LogCategories>\n  <DefaultExperiment startTime=\"0\" stepSize=\"{}\"/>\n",
        controller::STEP_S
    );
    match version {
        Version::Two => fmi2::write_variables(&mut xml, variables),
        Version::Three => fmi3::write_variables(&mut xml, variables),
    }
    xml.push_str("</fmiModelDescription>\n");
    xml
}

fn write_units(xml: &mut String, variables: &[Variable], of_time: Option<&'static str>) {
    let units = variables.iter().map(|variable| variable.unit);
    let units: BTreeSet<&str> = units.chain(of_time).collect();
    xml.push_str("  <UnitDefinitions>\n");
    for unit in units.into_iter().filter(|unit| !unit.is_empty()) {
        let name = escaped(unit);
        let _ = match units::base_attributes(unit) {
            Some(base) => writeln!(xml, "    <Unit name=\"{name}\"><BaseUnit {base}/></Unit>"),
            None => writeln!(xml, "    <Unit name=\"{name}\"/>"),
        };
    }
    xml.push_str("  </UnitDefinitions>\n");
}

/// Causality, variability and, where it is not the standard's, the source of the value at the start.
fn roles(variable: &Variable) -> String {
    let (causality, variability, initial) = match (variable.causality, variable.is_continuous()) {
        (Causality::Parameter, _) => ("parameter", "fixed", " initial=\"exact\""),
        (Causality::Input, true) => ("input", "continuous", ""),
        (Causality::Input, false) => ("input", "discrete", ""),
        (Causality::Output, true) => ("output", "continuous", " initial=\"calculated\""),
        (Causality::Output, false) => ("output", "discrete", " initial=\"calculated\""),
    };
    format!("causality=\"{causality}\" variability=\"{variability}\"{initial}")
}

/// The attribute `start`; none for a variable that is calculated.
fn start(variable: &Variable, value: &str) -> String {
    match variable.causality {
        Causality::Output => String::new(),
        Causality::Parameter | Causality::Input => format!(" start=\"{}\"", escaped(value)),
    }
}

/// Unit and range of a real number.
fn of_real(variable: &Variable) -> String {
    let mut attributes = String::new();
    if !variable.unit.is_empty() {
        let _ = write!(attributes, " unit=\"{}\"", escaped(variable.unit));
    }
    let ends = variable
        .range
        .map(|(low, high)| [("min", low), ("max", high)]);
    for (end, value) in ends
        .into_iter()
        .flatten()
        .filter(|(_, value)| value.is_finite())
    {
        let _ = write!(attributes, " {end}=\"{value}\"");
    }
    attributes
}

/// A text as the value of an attribute.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for sign in text.chars() {
        match sign {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&apos;"),
            // XML has no other control characters.
            '\t' | '\n' | '\r' => escaped.push(' '),
            sign if sign.is_control() || "\u{fffe}\u{ffff}".contains(sign) => {
                escaped.push('\u{fffd}')
            }
            sign => escaped.push(sign),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_leave_their_attribute() {
        assert_eq!(
            escaped("a<b>&\"c'\u{1}\n"),
            "a&lt;b&gt;&amp;&quot;c&apos;\u{fffd} "
        );
    }
}
