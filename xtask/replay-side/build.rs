//! Reads the declarations of inputs, outputs and limits from the firmware beside this crate, and writes the code that
//! converts them from and to words, each by its name.
//!
//! Commits differ in their fields. The source of this crate is the same for all of them.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::{env, fs};

const SIGNALS: &str = "quantities/src/signals/mod.rs";
const CONTROLLER: &str = "controller/src/controller.rs";
/// The limits of the envelope have a file of their own in later commits.
const ENVELOPE: [&str; 2] = ["safety/src/limits.rs", "safety/src/lib.rs"];
/// Types of outputs whose variants have codes; the others have a number in a unit.
const CODES: [&str; 4] = ["Fault", "Trip", "Reason", "Trouble"];

fn main() {
    let firmware = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../firmware");
    let source = |name: &str| {
        let path = firmware.join(name);
        println!("cargo::rerun-if-changed={}", path.display());
        fs::read_to_string(&path).unwrap_or_else(|error| {
            panic!("{}: {error}: this commit is older than the split into crates; compare with a later one", path.display())
        })
    };
    let signals = source(SIGNALS);
    let [own, shared] = ENVELOPE;
    let envelope = if firmware.join(own).exists() {
        own
    } else {
        shared
    };
    let code = [
        inputs(&signals),
        outputs(&fields(&signals, "Outputs")),
        limits(&fields(&source(envelope), "Limits")),
        calibration(&source(CONTROLLER)),
    ]
    .concat();
    let folder = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    fs::write(folder.join("interface.rs"), code).expect("cargo has made the folder");
}

/// Names and types of the public fields of a structure.
fn fields(source: &str, name: &str) -> Vec<(String, String)> {
    let head = format!("pub struct {name}");
    source
        .lines()
        .skip_while(|line| !line.starts_with(&head))
        .take_while(|line| *line != "}")
        .filter_map(|line| {
            line.strip_prefix("    pub ")?
                .strip_suffix(',')?
                .split_once(": ")
        })
        .map(|(name, kind)| (name.to_owned(), kind.to_owned()))
        .collect()
}

/// The type in an `Option`.
fn optional(kind: &str) -> Option<&str> {
    kind.strip_prefix("Option<")?.strip_suffix('>')
}

fn inputs(signals: &str) -> String {
    let (mut names, mut values) = (Vec::new(), String::new());
    let mut structure = |structure: &str, at: &str, inner: Option<&str>| {
        let mut body = String::new();
        for (name, kind) in fields(signals, structure) {
            if kind == "Switches" {
                let _ = write!(body, "{name}: {},", inner.unwrap_or_default());
                continue;
            }
            let word = format!("words[{}]", names.len());
            names.push(name.clone());
            if let Some(kind) = optional(&kind) {
                let _ = write!(body, "{name}: word::present({word}).map({kind}),");
                let _ = write!(values, "{at}.{name}.map_or(word::ABSENT, |value| value.0),");
            } else {
                let _ = write!(body, "{name}: {word} != 0,");
                let _ = write!(values, "i32::from({at}.{name}),");
            }
        }
        format!("{structure} {{ {body} }}")
    };
    let switches = structure("Switches", "inputs.switches", None);
    let inputs = structure("Inputs", "inputs", Some(&switches));
    format!(
        "/// Names of the inputs.\npub const INPUTS: [&str; {count}] = {names:?};\n\
         pub(crate) fn inputs(words: &[i32; {count}]) -> Inputs {{ {inputs} }}\n\
         /// The words of inputs.\npub fn words(inputs: &Inputs) -> [i32; {count}] {{ [{values}] }}\n",
        count = names.len()
    )
}

fn outputs(fields: &[(String, String)]) -> String {
    let names: Vec<&String> = fields.iter().map(|(name, _)| name).collect();
    let values = fields
        .iter()
        .map(|(name, kind)| match (optional(kind), kind.as_str()) {
            (Some(kind), _) if CODES.contains(&kind) => {
                format!("outputs.{name}.map_or(0, |code| code as i32),")
            }
            (Some("bool"), _) => format!("outputs.{name}.map_or(word::ABSENT, i32::from),"),
            (Some(_), _) => format!("outputs.{name}.map_or(word::ABSENT, |value| value.0),"),
            (None, "State" | "bool") => format!("outputs.{name} as i32,"),
            (None, _) => format!("outputs.{name}.0,"),
        });
    format!(
        "/// Names of the controller's outputs.\npub const OUTPUTS: [&str; {count}] = {names:?};\n\
         pub(crate) fn outputs(outputs: &Outputs) -> [i32; {count}] {{ [{values}] }}\n",
        count = names.len(),
        values = values.collect::<String>()
    )
}

fn limits(fields: &[(String, String)]) -> String {
    let values = fields.iter().map(|(name, _)| match name.as_str() {
        "damaged" => "damaged,".to_owned(),
        "machine" => "machine: hitch_safety::MachineModel::of(calibration),".to_owned(),
        part => format!("{part}: &calibration.{part},"),
    });
    format!(
        "pub(crate) fn limits(calibration: &Calibration, damaged: bool) -> Limits<'_> {{ Limits {{ {} }} }}\n",
        values.collect::<String>()
    )
}

/// How a controller takes another calibration.
fn calibration(controller: &str) -> String {
    let way = if controller.contains("pub fn apply(") {
        "apply"
    } else {
        "restart"
    };
    format!(
        "pub(crate) fn calibrate(controller: &mut Controller, calibration: ValidCalibration) {{ controller.{way}(calibration); }}\n"
    )
}
