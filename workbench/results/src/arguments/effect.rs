//! Resolves the name of an effect.

use hitch_input::naming::offer_names;
use hitch_plant::{Effect, Model, full_name};

use hitch_output::error::Error;

/// Looks up an effect by name: in the catalogue, or among the terms of the model file.
///
/// # Errors
/// If the name is unknown; the message suggests the most similar name.
pub fn find(model: &Model, id: &str) -> Result<&'static dyn Effect, Error> {
    let catalogue = hitch_effects::available(model);
    let found = catalogue
        .iter()
        .copied()
        .find(|effect| full_name(*effect) == id);
    found.ok_or_else(|| {
        let names: Vec<String> = catalogue.iter().map(|effect| full_name(*effect)).collect();
        let known: Vec<&str> = names.iter().map(String::as_str).collect();
        Error::Usage(format!(
            "effect {id:?} is not known; {}",
            offer_names(id, &known)
        ))
    })
}
