//! Model files: every constant of a plant and its added effects, as TOML.
//!
//! ```toml
//! format = 1
//! name = "rebuilt"
//! base = "nominal"            # optional: source of all constants not given below
//! dynamics = "steady"         # or "dynamic"
//!
//! [relief_valve]
//! set_pressure_bar = 154
//!
//! [[effect]]
//! id = "lower-threshold-shift"
//! shift_a = 0.199
//! ```
//!
//! A file can define its own terms in addition to the effects of the catalogue: see [`hitch_effects::expression`]. A
//! `[[term]]` is active once an `[[effect]]` adds it with a value for each parameter; until then a fit may try it.
//!
//! ```toml
//! [[term]]
//! id = "end-cushion"
//! place = "lower-flow-factor"
//! formula = "-c * ramp(1 - x / depth)"
//!
//! [[term.parameter]]          # the first one is its size, which is off at `null`
//! name = "c"
//! null = 0
//! start = 0.5
//! low = 0
//! high = 1
//!
//! [[term.parameter]]
//! name = "depth"
//! unit = "mm"
//! start = 20
//! low = 5
//! high = 50
//!
//! [[effect]]
//! id = "end-cushion"
//! c = 0.41
//! depth_mm = 22
//! ```
//!
//! The crate depends on the plant and its effects.
//!
//! Keys end in their unit. Without `base`, all constants are required; files written by the program are complete.
#![forbid(unsafe_code)]

mod constants;
mod meaning;
mod quoted;
mod read;
mod round_trip;
mod scalars;
mod starting_points;
mod template;
mod terms;
mod variant;
mod write;

pub use constants::{Constant, Role, Tolerance, fitted_constants};
pub use quoted::quoted;
pub use scalars::{Scalar, scalars, with_scalars};
pub use starting_points::{dynamic, nominal};
pub use template::Template;

use std::path::Path;

use hitch_effects::TermEffect;
use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use hitch_plant::Model;

use starting_points::starting_point;

/// A term as defined in a model file.
#[must_use]
pub fn term_text(term: &TermEffect) -> String {
    let mut text = String::new();
    terms::write(&mut text, term);
    text.trim_start().to_owned()
}

/// Reads a model file.
///
/// # Errors
/// A fault, with line and column.
pub fn read(path: &Path) -> Result<Model, InputError> {
    parse(&SourceFile::read(path)?)
}

/// Parses the text of a model file.
///
/// # Errors
/// A fault, with line and column.
pub fn parse(source: &SourceFile) -> Result<Model, InputError> {
    read::model(source, starting_point)
}

/// A built-in model by its name (`nominal`, `dynamic`), or else the model in the file with that name.
///
/// # Errors
/// A fault in the file, with line and column.
pub fn named(name: &str) -> Result<Model, InputError> {
    if let Some(model) = starting_point(name) {
        return Ok(model);
    }
    let path = Path::new(name);
    if path.exists() {
        return read(path);
    }
    Err(InputError::of_file(
        path,
        "no such model",
        "give nominal, dynamic or the name of a model file",
    ))
}

/// The text of a model file. Reading it returns the same model, bit for bit.
#[must_use]
pub fn to_toml(model: &Model) -> String {
    write::model(model)
}
