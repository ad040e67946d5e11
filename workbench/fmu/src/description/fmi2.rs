//! What FMI 2.0 has of its own.

use std::fmt::Write as _;

use super::{About, escaped, of_real, roles, start};
use crate::variable::{Causality, Value, Variable};

pub fn write_head(xml: &mut String, about: About<'_>) {
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

pub fn write_variables(xml: &mut String, variables: &[Variable]) {
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
