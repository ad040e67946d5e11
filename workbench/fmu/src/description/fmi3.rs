//! What FMI 3.0 has of its own.

use std::fmt::Write as _;

use super::{About, escaped, of_real, roles, start};
use crate::variable::{Causality, Value, Variable};

/// Unit of the independent variable.
pub const TIME_UNIT: &str = "s";

pub fn write_head(xml: &mut String, about: About<'_>) {
    let _ = write!(
        xml,
        "<fmiModelDescription fmiVersion=\"3.0\" modelName=\"{}\"\n    \
         instantiationToken=\"{}\"\n    \
         description=\"{}\" version=\"{}\" generationTool=\"hitch {}\"\n    \
         variableNamingConvention=\"structured\">\n  \
         <CoSimulation modelIdentifier=\"{}\" canHandleVariableCommunicationStepSize=\"true\"\n    \
         canGetAndSetFMUState=\"true\"/>\n",
        escaped(about.name),
        about.guid,
        about.text(),
        env!("CARGO_PKG_VERSION"),
        env!("CARGO_PKG_VERSION"),
        about.kind.identifier(),
    );
}

/// The variables, and time behind them, which this version wants among them.
pub fn write_variables(xml: &mut String, variables: &[Variable]) {
    xml.push_str("  <ModelVariables>\n");
    for (reference, variable) in variables.iter().enumerate() {
        write_variable(xml, reference, variable);
    }
    let _ = write!(
        xml,
        "    <Float64 name=\"time\" valueReference=\"{}\" causality=\"independent\" \
         variability=\"continuous\"\n      description=\"time\" unit=\"{TIME_UNIT}\"/>\n  </ModelVariables>\n",
        variables.len()
    );
    write_structure(xml, variables);
}

fn write_variable(xml: &mut String, reference: usize, variable: &Variable) {
    let (element, value, of_type) = match &variable.start {
        Value::Real(value) => ("Float64", value.to_string(), of_real(variable)),
        Value::Integer(value) => ("Int32", value.to_string(), String::new()),
        Value::Boolean(value) => ("Boolean", value.to_string(), String::new()),
        Value::Text(value) => ("String", value.clone(), String::new()),
    };
    let _ = write!(
        xml,
        "    <{element} name=\"{}\" valueReference=\"{reference}\" {}\n      \
         description=\"{}\"{of_type}",
        escaped(&variable.name),
        roles(variable),
        escaped(&variable.description),
    );
    let calculated = variable.causality == Causality::Output;
    let _ = match element {
        "String" if !calculated => {
            writeln!(xml, "><Start value=\"{}\"/></{element}>", escaped(&value))
        }
        _ => writeln!(xml, "{}/>", start(variable, &value)),
    };
}

fn write_structure(xml: &mut String, variables: &[Variable]) {
    xml.push_str("  <ModelStructure>\n");
    for element in ["Output", "InitialUnknown"] {
        for (reference, variable) in variables.iter().enumerate() {
            if variable.causality == Causality::Output {
                let _ = writeln!(xml, "    <{element} valueReference=\"{reference}\"/>");
            }
        }
    }
    xml.push_str("  </ModelStructure>\n");
}
