//! `modelDescription.xml`: what an importer has to know of a unit.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use crate::content::Kind;
use crate::controller;
use crate::units;
use crate::variable::{Causality, Value, Variable};

/// Categories of messages.
pub const LOG_CATEGORIES: [&str; 2] = ["logStatusDiscard", "logStatusError"];

/// The text of the file. (Writing to a string cannot fail.)
#[must_use]
pub fn write(kind: Kind, name: &str, guid: &str, variables: &[Variable]) -> String {
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    write_head(&mut xml, kind, name, guid);
    write_units(&mut xml, variables);
    xml.push_str("  <LogCategories>\n");
    for category in LOG_CATEGORIES {
        let _ = writeln!(xml, "    <Category name=\"{category}\"/>");
    }
    let _ = write!(
        xml,
        "  </LogCategories>\n  <DefaultExperiment startTime=\"0\" stepSize=\"{}\"/>\n  <ModelVariables>\n",
        controller::STEP_S
    );
    for (reference, variable) in variables.iter().enumerate() {
        write_variable(&mut xml, reference, variable);
    }
    xml.push_str("  </ModelVariables>\n");
    write_structure(&mut xml, variables);
    xml.push_str("</fmiModelDescription>\n");
    xml
}

fn write_head(xml: &mut String, kind: Kind, name: &str, guid: &str) {
    let about = match kind {
        Kind::Plant => "electro-hydraulic three-point hitch: valves, cylinder, linkage, load",
        Kind::Controller => "the firmware's controller of a three-point hitch",
    };
    let can_copy = kind == Kind::Controller;
    let _ = write!(
        xml,
        "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"{}\" guid=\"{guid}\"\n    \
         description=\"{about}\" version=\"{}\" generationTool=\"hitch {}\"\n    \
         variableNamingConvention=\"structured\">\n  \
         <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\"\n    \
         canInterpolateInputs=\"true\" canGetAndSetFMUstate=\"{can_copy}\"\n    \
         canNotUseMemoryManagementFunctions=\"true\"/>\n",
        escaped(name),
        env!("CARGO_PKG_VERSION"),
        env!("CARGO_PKG_VERSION"),
        kind.identifier(),
    );
}

fn write_units(xml: &mut String, variables: &[Variable]) {
    let units: BTreeSet<&str> = variables.iter().map(|variable| variable.unit).collect();
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

fn write_variable(xml: &mut String, reference: usize, variable: &Variable) {
    let (causality, variability, initial) = match (variable.causality, variable.is_continuous()) {
        (Causality::Parameter, _) => ("parameter", "fixed", " initial=\"exact\""),
        (Causality::Input, true) => ("input", "continuous", ""),
        (Causality::Input, false) => ("input", "discrete", ""),
        (Causality::Output, true) => ("output", "continuous", " initial=\"calculated\""),
        (Causality::Output, false) => ("output", "discrete", " initial=\"calculated\""),
    };
    let _ = write!(
        xml,
        "    <ScalarVariable name=\"{}\" valueReference=\"{reference}\" causality=\"{causality}\" \
         variability=\"{variability}\"{initial}\n      description=\"{}\">\n      ",
        escaped(&variable.name),
        escaped(&variable.description),
    );
    let calculated = variable.causality == Causality::Output;
    let start = |value: &str| match calculated {
        true => String::new(),
        false => format!(" start=\"{}\"", escaped(value)),
    };
    let _ = match &variable.start {
        Value::Real(value) => write!(
            xml,
            "<Real{}{}/>",
            start(&value.to_string()),
            of_real(variable)
        ),
        Value::Integer(value) => write!(xml, "<Integer{}/>", start(&value.to_string())),
        Value::Boolean(value) => write!(xml, "<Boolean{}/>", start(&value.to_string())),
        Value::Text(value) => write!(xml, "<String{}/>", start(value)),
    };
    xml.push_str("\n    </ScalarVariable>\n");
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

fn write_structure(xml: &mut String, variables: &[Variable]) {
    let outputs: String = variables
        .iter()
        .enumerate()
        .filter(|(_, variable)| variable.causality == Causality::Output)
        .map(|(place, _)| format!("      <Unknown index=\"{}\"/>\n", place + 1))
        .collect();
    let _ = write!(
        xml,
        "  <ModelStructure>\n    <Outputs>\n{outputs}    </Outputs>\n    \
         <InitialUnknowns>\n{outputs}    </InitialUnknowns>\n  </ModelStructure>\n"
    );
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
