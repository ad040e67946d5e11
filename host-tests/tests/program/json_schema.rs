//! JSON documents against a JSON Schema, by Python's `jsonschema`.
//!
//! The crate `jsonschema` does the same, but adds a minute of compilation and thirty packages to the tests.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

use host_tests::python::{installed, scripts};
use serde_json::{Value, json};

/// The faults of each document; `None` on a machine without Python or network, except in continuous integration.
pub fn faults(schema: &Value, documents: &[Value]) -> Option<Vec<Vec<String>>> {
    static PYTHON: OnceLock<Option<PathBuf>> = OnceLock::new();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = PYTHON.get_or_init(|| installed("schema.txt", folder));
    let mut child = Command::new(python.as_ref()?)
        .arg(scripts().join("validate.py"))
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("Python starts");
    let asked = json!({ "schema": schema, "documents": documents });
    let mut input = child.stdin.take().expect("a pipe");
    input
        .write_all(asked.to_string().as_bytes())
        .expect("it reads");
    drop(input);
    let output = child.wait_with_output().expect("it ends");
    assert!(output.status.success(), "{}", output.status);
    Some(serde_json::from_slice(&output.stdout).expect("lists of faults"))
}
