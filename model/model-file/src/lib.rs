//! Model files: every constant of a plant and its added effects, as TOML.
//!
//! ```toml
//! format = 1
//! name = "rebuilt"
//! base = "nominal"            # optional: what is not written below is as in this one
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
//! A file can have terms of its own beside the effects of the catalogue: see [`hitch_effects::expression`]. `[[term]]` defines
//! one; it acts once an `[[effect]]` adds it with a value for each parameter, and until then a fit may try it.
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
//! Depends on the plant and its effects.
//!
//! Keys end in their unit. Without `base`, every constant has to be there; a file that the program writes is complete.
#![forbid(unsafe_code)]

mod constants;
mod meaning;
mod read;
mod round_trip;
mod starting_points;
mod template;
mod terms;
mod write;

pub use starting_points::{dynamic, nominal};
pub use template::{Template, Valve};
pub use write::quoted;

use std::path::Path;

use hitch_effects::TermEffect;
use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use hitch_plant::Model;

/// A term as it stands in a model file.
#[must_use]
pub fn term_text(term: &TermEffect) -> String {
    let mut text = String::new();
    terms::write(&mut text, term);
    text.trim_start().to_owned()
}

/// The only format there is.
const FORMAT: f64 = 1.0;

/// Reads a model file.
///
/// # Errors
/// What is wrong with it, by line and column.
pub fn read(path: &Path) -> Result<Model, InputError> {
    parse(&SourceFile::read(path)?)
}

/// Reads a model file whose text is at hand.
///
/// # Errors
/// What is wrong with it, by line and column.
pub fn parse(source: &SourceFile) -> Result<Model, InputError> {
    read::model(source)
}

/// A starting point by its name (`nominal`, `dynamic`), or else the model of the file of that name.
///
/// # Errors
/// What is wrong with the file, by line and column.
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

/// The model as the text of a model file. To read it gives the same model, bit for bit.
#[must_use]
pub fn to_toml(model: &Model) -> String {
    write::model(model)
}

fn starting_point(name: &str) -> Option<Model> {
    match name {
        "nominal" => Some(nominal()),
        "dynamic" => Some(dynamic()),
        _ => None,
    }
}
