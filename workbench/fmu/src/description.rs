//! `modelDescription.xml`: what an importer has to know of a unit.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use crate::controller;
use crate::kind::Kind;
use crate::units;
use crate::variable::{Causality, Value, Variable};

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
pub fn write(about: About<'_>, variables: &[Variable]) -> String {
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    write_head(&mut xml, about);
    write_units(&mut xml, variables);
    xml.push_str("  <LogCategories>\n");
    for category in LOG_CATEGORIES {
        let _ = writeln!(xml, "    <Category name=\"{category}\"/>");
    }
    let _ = write!(
        xml,
        "  </LogCategories>\n  <DefaultExperiment startTime=\"0\" stepSize=\"{}\"/>\n",
        controller::STEP_S
    );
    write_variables(&mut xml, variables);
    xml.push_str("</fmiModelDescription>\n");
    xml
}

fn write_head(xml: &mut String, about: About<'_>) {
    let _ = write!(
        xml,
        "<fmiModelDescription fmiVersion=\"2.0\" modelName=\"{}\" guid=\"{}\"\n    \
         description=\"{}\" version=\"{}\" generationTool=\"hitch {}\"\n    \
         variableNamingConvention=\"structured\">\n  \
         <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\"\n    \
         canInterpolateInputs=\"true\" canGetAndSetFMUstate=\"true\"\n    \
         canNotUseMemoryManagementFunctions=\"true\"/>\n",
        escaped(about.name),
        about.guid,
        about.text(),
        env!("CARGO_PKG_VERSION"),
        env!("CARGO_PKG_VERSION"),
        about.kind.identifier(),
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

fn write_variables(xml: &mut String, variables: &[Variable]) {
    xml.push_str("  <ModelVariables>\n");
    for (reference, variable) in variables.iter().enumerate() {
        write_variable(xml, reference, variable);
    }
    xml.push_str("  </ModelVariables>\n");
    write_structure(xml, variables);
}

fn write_variable(xml: &mut String, reference: usize, variable: &Variable) {
    let _ = write!(
        xml,
        "    <ScalarVariable name=\"{}\" valueReference=\"{reference}\" {}\n      \
         description=\"{}\">\n      ",
        escaped(&variable.name),
        roles(variable),
        escaped(&variable.description),
    );
    let start = |value: &str| start(variable, value);
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
